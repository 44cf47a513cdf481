#pragma once

#include <memory>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Limits on the corridors to refine.
struct CorridorChoice {
  std::size_t most = 3;  ///< largest number of corridors, cheapest on the grid first
  /// Largest relative excess over the cheapest grid route. Eight headings overestimate the length of a
  /// straight line by up to 8.2 %, so a corridor with a grid cost up to 8.2 % higher may be the cheaper
  /// corridor.
  double within = 0.082;
};

/// Grid routes between two places through corridors other than that of a known route, which local refinement
/// does not find. The caller refines and compares the routes. `to_goal` is the field of the second place on
/// the map of `cost`; the whole field is settled.
///
/// Method (ours, not from the literature). The field from the start is the field to the start on terrain with
/// reversed gradients: a heading costs there as much as the opposite heading on the map. The sum of both
/// fields is the cost of the cheapest grid route through each cell. A corridor is the route through the
/// cheapest cell of a square of 8 x 8 cells, away from all known routes, that shares at least eight
/// consecutive cells with no cheaper route (a plateau of the sum of both fields).
std::vector<Polyline> otherCorridors(const MotionCost& cost,
                                     const std::shared_ptr<const costmap::CostGrid>& map, CostToGo& to_goal,
                                     const Segment& places, const Polyline& known,
                                     const CorridorChoice& choice = {}, const StopCheck& stop = {});

}  // namespace talus::planner
