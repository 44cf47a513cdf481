#pragma once

#include <vector>

#include <talus/planner/route/arc.hpp>

namespace talus::planner {

/// The shortest way forward between two poses with a turning radius > 0 (dubins_1957), in the closed forms of
/// shkel_lumelsky_2001. OMPL 1.5.2's own holds its result against a bound that long ways miss by rounding,
/// and then aborts the process.
std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m);

}  // namespace talus::planner
