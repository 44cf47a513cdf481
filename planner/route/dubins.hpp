#pragma once

#include <vector>

#include <talus/planner/route/arc.hpp>

namespace talus::planner {

/// Returns the shortest path without reversing from `from` to `to`, with arcs of the turning radius
/// `radius_m` > 0 (dubins_1957), in the closed forms of shkel_lumelsky_2001. The implementation of OMPL 1.5.2
/// is not used: it compares the length with a bound, which long paths miss by rounding, and then aborts the
/// process.
std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m);

}  // namespace talus::planner
