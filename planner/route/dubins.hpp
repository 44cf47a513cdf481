#pragma once

#include <vector>

#include <talus/planner/route/arc.hpp>

namespace talus::planner {

/// Shortest forward path between two poses with a turning radius > 0 (dubins_1957), in the closed forms of
/// shkel_lumelsky_2001. OMPL 1.5.2's implementation compares its result with a bound that long paths miss by
/// rounding, and then aborts the process.
std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m);

}  // namespace talus::planner
