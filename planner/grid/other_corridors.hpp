#pragma once

#include <memory>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Limits for the choice of corridors (homotopically different routes) that are refined.
struct CorridorChoice {
  std::size_t most = 3;  ///< largest number of corridors, in order of increasing grid cost
  /// Largest relative difference of a grid cost from the cheapest grid route. Routes in eight headings are up
  /// to 8.2 % longer than a straight line; therefore a corridor with a grid cost up to 8.2 % higher may be
  /// the cheaper corridor.
  double within = 0.082;
};

/// Returns grid routes from `places.from` to `places.to` through corridors other than that of the route
/// `known`. Local refinement of `known` does not find these routes. The caller refines and compares the
/// routes. `to_goal` is the cost-to-go field of `places.to` on the map of `cost`; the function settles the
/// whole field.
///
/// Method (ours, not from the literature). The cost field from the start equals the cost-to-go field of the
/// start on terrain with reversed gradients, because there the cost of a heading is the cost of the opposite
/// heading on the map. The sum of both fields is the cost of the cheapest grid route through each cell. A
/// corridor is the route through the cheapest cell of a square of 8 x 8 cells away from all known routes. The
/// route must have at least eight consecutive cells that no cheaper route has (a plateau of the sum of both
/// fields).
std::vector<Polyline> otherCorridors(const MotionCost& cost,
                                     const std::shared_ptr<const costmap::CostGrid>& map, CostToGo& to_goal,
                                     const Segment& places, const Polyline& known,
                                     const CorridorChoice& choice = {}, const StopCheck& stop = {});

}  // namespace talus::planner
