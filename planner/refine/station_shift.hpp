#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Where a station of a route may move to.
struct ShiftOptions {
  int candidates = 8;  ///< places to each side, the stations' distance over this apart
  int swing = 3;       ///< most steps sideways from one station to the next
};

/// One round: stations are set piece_m apart along the route, with places to both sides of each, and dynamic
/// programming picks a place at every station; between two stations the present way may be kept. Ours, not
/// from the literature. The route itself when stopped.
Polyline shifted(const MotionCost& cost, const Polyline& route, double piece_m,
                 const ShiftOptions& options = {}, const StopCheck& stop = {});

}  // namespace talus::planner
