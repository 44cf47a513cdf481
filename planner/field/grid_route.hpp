#pragma once

#include <optional>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Returns the cheapest grid route from `places.from` to `places.to`. The route leads straight to the centre
/// of a cell near the start, then from centre to centre along the cost-to-go field, then straight to the goal
/// if that motion is allowed. The goals of the field must be fieldGoals() of `places.to`. The result is empty
/// if there is no route, or after a stop.
Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places,
                   const StopCheck& stop = {});

/// Returns the cheapest grid route after the step costs in the box `changed` changed, computed from `before`,
/// the field before the change. Returns nullopt if an update of the field takes less time; an empty route if
/// there is no route or after a stop.
std::optional<Polyline> gridRouteAfter(CellBox changed, const MotionCost& cost, const CostToGo& before,
                                       const Segment& places, const StopCheck& stop = {});

}  // namespace talus::planner
