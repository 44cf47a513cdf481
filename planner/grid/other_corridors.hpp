#pragma once

#include <memory>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Which corridors are worth refining.
struct CorridorChoice {
  std::size_t most = 3;  ///< so many, cheapest on the grid first
  /// Of the cheapest grid route: dearer ones are left. Eight headings overstate a straight way by up to 8.2 %, so a corridor
  /// that much dearer on the grid may be the cheaper one.
  double within = 0.082;
};

/// Grid routes between two places through other corridors than that of a known route, which refinement near it does not
/// find: to be refined and compared. The field is that of the second place on the map of the cost, and is settled as a whole.
///
/// How (ours). The field from the start is the field to it over the ground turned upside down: a heading costs there what the
/// opposite heading costs here. Both fields add up to the cost of the best grid route through each cell. A corridor is the
/// route through the cheapest cell of a square of eight cells a side, away from all routes known, that shares at least
/// eight cells in a row with no cheaper one (a plateau of both fields).
std::vector<Polyline> otherCorridors(const MotionCost& cost,
                                     const std::shared_ptr<const costmap::CostGrid>& map, CostToGo& to_goal,
                                     const Segment& places, const Polyline& known,
                                     const CorridorChoice& choice = {}, const StopCheck& stop = {});

}  // namespace talus::planner
