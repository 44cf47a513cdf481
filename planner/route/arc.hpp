#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Position and heading of the rover.
struct Pose {
  maps::Point place;         ///< map coordinates [m]
  double heading_rad = 0.0;  ///< heading, counter-clockwise from x (east)
};

/// Path section of constant curvature: a circular arc or a straight line.
struct Arc {
  double length_m = 0.0;       ///< signed length, > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< curvature [1/m], > 0 for an arc to the left of the heading
};

/// Returns the pose at the end of an arc that starts at `from`.
Pose after(const Pose& from, const Arc& arc) noexcept;

}  // namespace talus::planner
