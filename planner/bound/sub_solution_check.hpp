#pragma once

#include <talus/planner/bound/sub_solution.hpp>

namespace talus::planner {

/// Lower bound proven by a sub-solution.
struct Proof {
  double bound_J = 0.0;  ///< no route from the start to the goal costs less [J]
  double excess = 1.0;   ///< >= 1; the solution divided by `excess` satisfies every limit
};

/// Verifies a sub-solution against the limits of its cells and at its border. Returns a bound of 0 if nothing
/// is proven.
///
/// Proof (ours, not from the literature). Let w be the largest ratio, over all triangles of the solution and
/// all 64 headings, of the fall of the solution u per metre to the cell's limit. Then u / w satisfies all
/// limits, so a route that stays on these triangles costs at least (u(start) - u(goal)) / w. A route that
/// leaves these triangles crosses a side whose two nodes are both outer nodes. There u + d >= K, with d the
/// cost of the straight line from the start at the lowest cost per metre and K the cost of a known route: the
/// route costs at least d before the side and at least (u - u(goal)) / w after the side.
Proof provenBy(const SubSolution& solution, const SubSolution::Parts& parts);

}  // namespace talus::planner
