#pragma once

#include <functional>
#include <string>

#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/planner/reach/reach.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Finds the obstruction between `places.from` (start) and `places.to` (goal): the set of cells reachable
/// from the start, the set of cells from which the goal is reachable, and the constraint that separates both
/// sets. Each constraint is tested by a computation of both sets on a map without this constraint
/// (LiftedGround), on maps of up to kTriedCells only. After a stop, or if a set is empty, start and goal are
/// returned instead of the closest cells of both sets.
Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, const Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards = {},
                               const StopCheck& stop = {});

/// Function that returns true if `map` connects start and goal.
using OpensOn = std::function<bool(const costmap::CostGrid& map)>;

/// Tests which constraint causes the obstruction `found`, and stores it in `found`. The two sets of cells of
/// `found` must be known. After a stop, or on maps with more than kTriedCells cells, no constraint is tested.
void tryLifting(Obstruction& found, const costmap::CostGrid& map, const HazardsOf& hazards,
                const OpensOn& opens, const StopCheck& stop = {});

/// Returns one line of text with the numbers of cells, the closest cells, and the constraint that must be
/// changed.
std::string text(const Obstruction& obstruction, const Segment& places);

/// Largest number of cells of a map for which constraints are tested.
inline constexpr std::size_t kTriedCells = 4'000'000;

}  // namespace talus::planner
