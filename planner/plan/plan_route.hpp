#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Plans one route over a version of the map by the planner that the settings name. The search keeps the chassis and the
/// risk limit of the request; what it finds is held against violations(), and each vertex has the elevation of the map.
/// makePlanner() gives the same routes and keeps what it computed for the next one. No route is a status with its reason.
/// Throws std::invalid_argument without a map, for a field out of its range and for one that the planner does not honour.
Route planRoute(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                const PlannerSettings& settings = {});

/// The same by planner "field" on a map that is not held in memory: the overview's route guides, and full
/// resolution is built beside it. The settings' planner is "field" or empty. No route is no proof here: a way
/// that the overview does not show is missed. Via points alone are honoured.
Route planRoute(WindowedMap& map, const PlanRequest& request, const PlannerSettings& settings = {});

}  // namespace talus::planner
