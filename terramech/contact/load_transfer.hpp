#pragma once

#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Returns the normal load [N] on each of n equal wheels of a rover on a plane whose slope along the heading
/// is tan(alpha) = gradient (rise over run). Wheel k stands a_k = along_m[k] ahead of the mean wheel
/// position. The downhill component of the weight acts at the height h of the centre of mass and transfers
/// load to the rear wheels:
///   N_k = m g cos(alpha) (1/n - tan(alpha) h a_k / sum a^2)
/// For two axles at distance L the transferred load is m g sin(alpha) h / L. Each load is raised to at least
/// 0.1 m g cos(alpha) / n, so that no wheel lifts off; the other loads are not reduced to compensate. The
/// result is empty if along_m is empty.
std::vector<double> wheelLoads_N(const Rover& rover, double gradient, const std::vector<double>& along_m);

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
