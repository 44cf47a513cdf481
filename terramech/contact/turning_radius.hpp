#pragma once

namespace talus::terramech {

/// Turning radii [m] that a rover may have beside 0. Below, curves are no shorter than a turn in place and lose their digits
/// (radii of 1e-9 m ended the process); above, tables grow with it, and no rover turns wider.
inline constexpr double kSmallestTurn_m = 1e-3;
inline constexpr double kLargestTurn_m = 1000.0;

/// Whether a rover may have this turning radius: 0, which turns in place, or kSmallestTurn_m to kLargestTurn_m.
constexpr bool isTurningRadius(double radius_m) noexcept {
  return radius_m == 0.0 || (radius_m >= kSmallestTurn_m && radius_m <= kLargestTurn_m);
}

}  // namespace talus::terramech
