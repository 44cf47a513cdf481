#pragma once

#include <talus/planner/planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route on a map that does not fit in memory. The route on the overview is the guide, and each leg
/// is planned on the tiles near the guide. Replaces problem.map by the map of the last leg.
Plan planInWindows(Problem& problem, WindowedMap& map);

}  // namespace talus::planner
