#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Where the rover is and where it looks.
struct Pose {
  maps::Point place;
  double heading_rad = 0.0;  ///< counter-clockwise from x
};

/// A stretch of constant curvature.
struct Arc {
  double length_m = 0.0;       ///< > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< > 0 to the left of the heading
};

/// The pose at the end of an arc that starts at a pose.
Pose after(const Pose& from, const Arc& arc) noexcept;

}  // namespace talus::planner
