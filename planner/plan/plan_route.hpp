#pragma once

#include <memory>
#include <string>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Plans one route on a map with the planner named in `settings`. The search takes account of the chassis and
/// the risk limit of `request`. The route is checked with violations(), and each vertex has the elevation of
/// the map. If there is no route, the result has the status and the reason. A planner of makePlanner()
/// returns the same routes and keeps data for later requests. Throws std::invalid_argument if `map` is null,
/// if a field of the request is out of its range, or if the planner does not support a field that is set.
Route planRoute(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                const PlannerSettings& settings = {});

/// Plans one route with the planner "field" on a map that is not held in memory. A route on a coarse overview
/// of the map guides the search, and windows of full resolution are computed along the overview route.
/// `settings.planner` must be "field" or empty. The status NoRoute is not a proof, because routes that the
/// overview does not resolve are missed. Of the optional constraints only via points are supported.
Route planRoute(WindowedMap& map, const PlanRequest& request, const PlannerSettings& settings = {});

/// Creates one of Talus' own planners with default settings; no shared library is loaded. `name` is the name
/// of the planner; an empty name selects the default planner. GlobalPlanner::capabilities().planners contains
/// the names. Throws std::invalid_argument for an unknown name.
std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name = {});

}  // namespace talus::planner
