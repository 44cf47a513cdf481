#pragma once

#include <optional>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// The cheapest way along the grid between two places: to the centre of a cell beside the first, from centre
/// to centre down the field, on to the second where the field's goal requires it. Empty when there is none,
/// or when stopped. The field's goals must be fieldGoals() of the second place.
Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places,
                   const StopCheck& stop = {});

/// The same after the edges of a box of cells changed, from the field before the change. Nothing when that
/// takes more work than to repair the field.
std::optional<Polyline> gridRouteAfter(CellBox changed, const MotionCost& cost, const CostToGo& before,
                                       const Segment& places, const StopCheck& stop = {});

}  // namespace talus::planner
