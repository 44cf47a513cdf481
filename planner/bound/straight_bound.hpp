#pragma once

#include <limits>

#include <talus/costmap/cost/cost_grid.hpp>
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
/// How (ours). Let D be the distance and S >= 2 D. A route that leaves the ellipse of the places with distances
/// that sum to S does so at least (S - D) / 2 from the one place and comes back as far from the other; so it
/// drives D metres inside, as does one that stays, and each costs the cheapest metre there. A route of at most
/// known_J stays within S = known_J over that metre, which may be less. A tolerance shortens all of this alike.
/// Time: some nanoseconds a cell of the ellipse's box and round.
double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J = std::numeric_limits<double>::infinity(),
                           const StopCheck& stop = {});

}  // namespace talus::planner
