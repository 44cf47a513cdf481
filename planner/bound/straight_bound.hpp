#pragma once

#include <limits>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns a lower bound [J] of the cost of any motion from the first place to within tolerance_m of the
/// second: distance times the lowest cost per metre of all drive curves. Reads no cell.
double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m = 0.0);

/// Returns a lower bound [J] with the lowest cost per metre of the reachable cells, never below
/// straightBound_J() unless known_J is. `known_J` is the cost of a known route, infinite if none is known;
/// the result never exceeds known_J. On uniform ground the bound proves the straight line optimal. When
/// stopped, returns the bound found so far.
///
/// Derivation (ours, not from the literature). Let D be the distance and S >= 2 D. A route that leaves the
/// ellipse of points whose distances to both places sum to S drives at least (S - D) / 2 from the first place
/// to the boundary and at least as far back to the second. Every route therefore drives D metres inside the
/// ellipse, each at no less than the lowest cost per metre there. A route of at most known_J is no longer
/// than S = known_J / (that cost per metre), also if S < 2 D. A tolerance shortens all lengths equally. Time:
/// a few nanoseconds per cell of the ellipse's bounding box and iteration.
double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J = std::numeric_limits<double>::infinity(),
                           const StopCheck& stop = {});

}  // namespace talus::planner
