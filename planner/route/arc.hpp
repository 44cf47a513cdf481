#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Position and heading of the rover.
struct Pose {
  maps::Point place;         ///< [m]
  double heading_rad = 0.0;  ///< counter-clockwise from x
};

/// A path section of constant curvature.
struct Arc {
  double length_m = 0.0;       ///< > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< > 0 to the left of the heading
};

/// Pose at the end of an arc that starts at `from`.
Pose after(const Pose& from, const Arc& arc) noexcept;

}  // namespace talus::planner
