#pragma once

namespace talus::terramech {

/// Smallest and greatest accepted turning radius [m] of a rover, apart from 0 (turn in place). The smallest
/// radius keeps arcs resolvable in double precision (a radius of 1e-9 m ended the process); a smaller radius
/// is practically a turn in place. The greatest radius exceeds that of any rover and limits the size of
/// tables.
inline constexpr double kSmallestTurn_m = 1e-3;
inline constexpr double kLargestTurn_m = 1000.0;

/// Returns true if a turning radius [m] is 0 (turn in place) or in [kSmallestTurn_m, kLargestTurn_m].
constexpr bool isTurningRadius(double radius_m) noexcept {
  return radius_m == 0.0 || (radius_m >= kSmallestTurn_m && radius_m <= kLargestTurn_m);
}

}  // namespace talus::terramech
