#pragma once

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::cli {

class WindowedGround;

/// A route on a map that is not held in memory: the overview's route guides, and each leg is planned in the
/// tiles beside it. The problem's map becomes that of the last leg.
planner::Plan planInWindows(planner::Problem& problem, WindowedGround& ground);

}  // namespace talus::cli
