#pragma once

#include <limits>

#include <talus/costmap/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// No motion of any shape from the one place to within the tolerance of the other costs less: the distance at
/// the cheapest metre of any ground. Reads no cell.
double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m = 0.0);

/// The same at the cheapest metre of the cells that matter, never lower. `known_J` is the cost of some route, infinite
/// if none is known: no dearer route is asked about, so the answer never exceeds it. Sharp where the ground between the
/// places is even: there the straight line is proven to be the best.
///
/// How (ours). A route of at most known_J is no longer than known_J over the cheapest metre; so it stays in the ellipse
/// about both places of that sum of distances, wider by the tolerance. The cheapest metre of the cells there may be dearer,
/// which makes the ellipse smaller: some rounds; as far as it came when stopped. Time: some nanoseconds a cell of the ellipse's box and round.
double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J = std::numeric_limits<double>::infinity(),
                           const StopCheck& stop = {});

}  // namespace talus::planner
