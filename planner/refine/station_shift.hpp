#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Number and spacing of the positions to which a station of a route may move sideways.
struct ShiftOptions {
  int candidates = 8;  ///< positions to each side; their spacing is the stations' spacing divided by
                       ///< `candidates`
  int swing = 3;       ///< largest sideways change [steps] between consecutive stations
};

/// Shifts the route sideways once: stations are set piece_m apart along the route, with candidate positions
/// on both sides, and dynamic programming selects a position at every station. Between two stations the
/// present path may be kept. Ours, not from the literature. Returns the route unchanged when stopped.
Polyline shifted(const MotionCost& cost, const Polyline& route, double piece_m,
                 const ShiftOptions& options = {}, const StopCheck& stop = {});

}  // namespace talus::planner
