#pragma once

#include <limits>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns the lowest cost per metre [J/m] over all cost curves (kinds of ground, costmap::TravelCurve) that
/// occur on the map and all gradients; 0 if no cell has a cost curve. Only row 0 of each cost curve (no
/// gradient across the heading) is read, because no other row has a lower cost.
double cheapestMetre_J(const costmap::CostGrid& map);

/// Returns a lower bound [J] of the cost of any motion from `places.from` to within `tolerance_m` of
/// `places.to`: the distance times the lowest cost per metre of all cost curves (kinds of ground). The
/// function reads no cell.
double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m = 0.0);

/// Returns a lower bound [J] from the lowest cost per metre of the reachable cells. `known_J` is the cost of
/// a known route, infinite if none is known. The result is at least min(straightBound_J(), known_J) and at
/// most known_J. On uniform ground the bound proves that the straight line is optimal. After a stop, returns
/// the bound found so far.
///
/// Derivation (ours, not from the literature). Let D be the distance and S >= 2 D. The points whose distances
/// to both places sum to at most S form an ellipse. A route that leaves the ellipse drives at least (S - D) /
/// 2 from the first place to its boundary and at least the same distance back to the second place. Therefore
/// every route drives D metres inside the ellipse, each at no less than the lowest cost per metre there. A
/// route of at most known_J is no longer than S = known_J / (lowest cost per metre), also if S < 2 D. A
/// tolerance shortens all lengths equally. The computation takes a few nanoseconds per cell of the bounding
/// box of the ellipse and iteration.
double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J = std::numeric_limits<double>::infinity(),
                           const StopCheck& stop = {});

}  // namespace talus::planner
