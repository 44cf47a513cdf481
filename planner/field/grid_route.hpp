#pragma once

#include <optional>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Cheapest grid route between two places: to the centre of a cell near the first place, from centre to
/// centre along the field, and to the second place if a straight motion leads there. Empty if there is no
/// route, or when stopped. The field's goals must be the fieldGoals() of the second place.
Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places,
                   const StopCheck& stop = {});

/// Cheapest grid route after the edges of a box of cells changed, from the field before the change. Returns
/// nullopt if repairing the field takes less work; an empty route if there is none or when stopped.
std::optional<Polyline> gridRouteAfter(CellBox changed, const MotionCost& cost, const CostToGo& before,
                                       const Segment& places, const StopCheck& stop = {});

}  // namespace talus::planner
