#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Plans one route on a map with the planner named in the settings. The search honours the chassis and the
/// risk limit of the request; the result is checked with violations(), and each vertex has the elevation of
/// the map. If there is no route, the status and reason are returned. makePlanner() gives the same routes and
/// caches data for later requests. Throws std::invalid_argument without a map, for a field out of its range,
/// and for a field that the planner does not honour.
Route planRoute(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                const PlannerSettings& settings = {});

/// Plans with planner "field" on a map that is not held in memory: the route of the overview guides the
/// search, and windows of full resolution are built along it. The settings' planner must be "field" or empty.
/// NoRoute is not a proof: routes that the overview does not show are missed. Of the optional constraints
/// only via points are honoured.
Route planRoute(WindowedMap& map, const PlanRequest& request, const PlannerSettings& settings = {});

}  // namespace talus::planner
