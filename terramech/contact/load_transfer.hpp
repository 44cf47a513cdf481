#pragma once

#include <vector>

#include <talus/terramech/contact/rover.hpp>

namespace talus::terramech {

/// Returns the normal load [N] on each of n equal wheels on a plane with the slope tan(alpha) = gradient
/// (rise over run) along the heading. Wheel k stands a_k = along_m[k] ahead of the middle of the wheels. The
/// moment of the downhill weight component, at the height h of the centre of mass, transfers load to the
/// rear:
///   N_k = m g cos(alpha) (1/n - tan(alpha) h a_k / sum a^2)
/// For two axles at distance L the transferred load is m g sin(alpha) h / L. Loads are limited to at least
/// 0.1 m g cos(alpha) / n, so that no wheel lifts off; the other loads are not reduced to compensate. Returns
/// an empty vector if along_m is empty.
std::vector<double> wheelLoads_N(const Rover& rover, double gradient, const std::vector<double>& along_m);

}  // namespace talus::terramech
