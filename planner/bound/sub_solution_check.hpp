#pragma once

#include <talus/planner/bound/sub_solution.hpp>

namespace talus::planner {

/// What a sub-solution proves.
struct Proof {
  double bound_J = 0.0;  ///< no route from the start to the goal costs less
  double excess = 1.0;   ///< >= 1: the solution over this keeps every limit
};

/// Verifies a sub-solution against the limits of its cells and its border; a bound of 0 where it proves nothing.
///
/// The proof (ours). Let w be the largest ratio, over all triangles of the solution and all 64 headings, of what a
/// metre takes of the solution u and the cell's limit. Then u / w keeps all limits, so a route that stays on these
/// triangles costs at least (u(start) - u(goal)) / w. One that leaves them does so over a side both of whose nodes
/// are outer, with u + d >= K there, d the way from the start at the cheapest metre, K the cost of a route that is
/// known: it costs d before and (u - u(goal)) / w or more from there on.
Proof provenBy(const SubSolution& solution, const SubSolution::Parts& parts);

}  // namespace talus::planner
