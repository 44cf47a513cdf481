#pragma once

#include <talus/planner/bound/sub_solution.hpp>

namespace talus::planner {

/// Lower bound proven by a sub-solution.
struct Proof {
  double bound_J = 0.0;  ///< lower bound of the cost of every route from the start to the goal [J]
  double excess = 1.0;   ///< smallest factor >= 1 such that the solution divided by it satisfies every limit
};

/// Verifies a sub-solution against the limits of its cells and at its border. Returns a bound of 0 if nothing
/// is proven.
///
/// Proof (ours, not from the literature). For all triangles of the solution u and all 64 headings, let w be
/// the largest ratio of the decrease of u per metre to the limit of the cell. Then u / w satisfies all
/// limits; therefore a route that stays on these triangles costs at least (u(start) - u(goal)) / w. A route
/// that leaves these triangles crosses a side with two outer nodes (nodes that the search did not expand). On
/// this side u + d >= K, where d is the cost of the straight line from the start at the lowest cost per
/// metre, and K is the cost of a known route. The route costs at least d before the side and at least (u -
/// u(goal)) / w after the side.
Proof provenBy(const SubSolution& solution, const SubSolution::Parts& parts);

}  // namespace talus::planner
