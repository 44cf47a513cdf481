#pragma once

#include <functional>
#include <string>

#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/planner/reach/reach.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Where two places are cut off from each other: the sets reached from one and leading to the other, and, by building both
/// anew without each constraint in turn (LiftedGround), which of them does it. On maps above kTriedCells none is lifted. Stopped, or where a
/// set is empty, it has the places themselves in place of the cells that come closest.
Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, const Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards = {},
                               const StopCheck& stop = {});

/// Whether a map joins the two places.
using OpensOn = std::function<bool(const costmap::CostGrid& map)>;

/// Only the search for the constraint, on an obstruction whose sets are known. Stopped, or on maps above kTriedCells, none is tried.
void tryLifting(Obstruction& found, const costmap::CostGrid& map, const HazardsOf& hazards,
                const OpensOn& opens, const StopCheck& stop = {});

/// One line: how many cells, where they come closest, what to change.
std::string text(const Obstruction& obstruction, const Segment& places);

inline constexpr std::size_t kTriedCells = 4'000'000;

}  // namespace talus::planner
