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
/// limits; therefore a route costs at least (u(p) - u(goal)) / w behind a place p after which it stays on these
/// triangles. If it does not stay on them from the start on, p is on a side with two outer nodes (nodes that the
/// search did not expand), and the route costs at least the lower bound from the start before p. A search that
/// ended early thus extends the bounds from the start by the part near the goal that it reached.
Proof provenBy(const SubSolution& solution, const SubSolution::Parts& parts);

}  // namespace talus::planner
