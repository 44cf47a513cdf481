#pragma once

#include <functional>
#include <string>

#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/planner/reach/reach.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Finds the obstruction between two places: the set reachable from the start, the set from which the goal is
/// reachable, and the constraints that separate them. Each constraint is tested by recomputing both sets
/// without the constraint (LiftedGround), on maps of up to kTriedCells only. After a stop, or if a set is
/// empty, the places themselves are returned instead of the closest cells.
Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, const Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards = {},
                               const StopCheck& stop = {});

/// Returns true if the map connects the two places.
using OpensOn = std::function<bool(const costmap::CostGrid& map)>;

/// Tests the constraints of an obstruction whose sets are known. After a stop, or on maps above kTriedCells,
/// no constraint is tested.
void tryLifting(Obstruction& found, const costmap::CostGrid& map, const HazardsOf& hazards,
                const OpensOn& opens, const StopCheck& stop = {});

/// Returns one line: number of cells, closest cells, and the constraint to change.
std::string text(const Obstruction& obstruction, const Segment& places);

inline constexpr std::size_t kTriedCells = 4'000'000;

}  // namespace talus::planner
