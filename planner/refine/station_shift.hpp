#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Number and spacing of the candidate positions beside a station (point at equal spacing along a route).
struct ShiftOptions {
  /// Number of positions on each side of a station; their spacing is the station spacing / `candidates`.
  int candidates = 8;
  /// Largest difference of sideways positions between consecutive stations, in candidate spacings.
  int swing = 3;
};

/// Shifts a route sideways once. Stations are placed `piece_m` apart along the route, with candidate
/// positions on both sides, and dynamic programming selects a position at every station. Between two stations
/// the present path may also be kept. Ours, not from the literature. After a stop, the route is returned
/// unchanged.
Polyline shifted(const MotionCost& cost, const Polyline& route, double piece_m,
                 const ShiftOptions& options = {}, const StopCheck& stop = {});

}  // namespace talus::planner
