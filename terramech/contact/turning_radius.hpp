#pragma once

namespace talus::terramech {

/// Smallest and greatest accepted turning radius [m] other than 0. A curve of a smaller radius is no longer
/// than a turn in place and is not resolved in double precision (a radius of 1e-9 m ended the process). The
/// greatest radius is above that of any rover; tables grow with the radius.
inline constexpr double kSmallestTurn_m = 1e-3;
inline constexpr double kLargestTurn_m = 1000.0;

/// Returns whether a turning radius [m] is valid: 0 (turn in place) or in [kSmallestTurn_m, kLargestTurn_m].
constexpr bool isTurningRadius(double radius_m) noexcept {
  return radius_m == 0.0 || (radius_m >= kSmallestTurn_m && radius_m <= kLargestTurn_m);
}

}  // namespace talus::terramech
