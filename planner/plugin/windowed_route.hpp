#pragma once

#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// A route by planner "field" on a map that is not held in memory: the overview's route guides, and full
/// resolution is built beside it. The settings' planner is "field" or empty. No route is no proof here: a way
/// that the overview does not show is missed. Throws std::invalid_argument as GlobalPlanner::configure() and
/// plan(); via points alone are honoured.
Route routeInWindows(const PlanRequest& request, WindowedMap& map, const PlannerSettings& settings = {});

}  // namespace talus::planner
