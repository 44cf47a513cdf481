#pragma once

#include <functional>
#include <optional>
#include <string>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Returns the cheapest grid route from `places.from` to `places.to`. The route leads straight to the centre
/// of a cell near the start, then from centre to centre along the cost-to-go field, then straight to the goal
/// if that motion is allowed. The goals of the field must be fieldGoals() of `places.to`. The result is empty
/// if there is no route, or after a stop.
Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places,
                   const StopCheck& stop = {});

/// Information about the cells around an invalid start or goal, for the error message.
struct PlaceDiagnostics {
  HazardsOf hazards{};  ///< hazard of a cell without allowed heading; empty if not known
  /// Returns true if a route connects a cell with the other end (goal or start); empty if not known.
  std::function<bool(maps::Cell)> joined{};
};

/// Returns one line of text for an invalid start or goal at `place`: the reason, and the nearest traversable
/// cell, if possible a cell that is connected with the other end of the route. `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place,
                         const PlaceDiagnostics& help = {});

/// Returns true if a route may end near `place`: some heading is allowed at the place itself, or at a cell
/// centre within the tolerance `tolerance_m` >= 0 of the place.
bool mayEnd(const MotionCost& cost, maps::Point place, double tolerance_m);

}  // namespace talus::planner
