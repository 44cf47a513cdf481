#pragma once

#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// A route on a map that is not held in memory: the overview's route guides, and each leg is planned in the
/// tiles beside it. The problem's map becomes that of the last leg.
Plan planInWindows(Problem& problem, WindowedMap& map);

}  // namespace talus::planner
