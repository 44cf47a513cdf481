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

}  // namespace talus::terramech
