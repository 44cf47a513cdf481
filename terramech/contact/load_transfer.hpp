#pragma once

#include <vector>

#include <talus/terramech/contact/rover.hpp>

namespace talus::terramech {

/// Loads [N] of equal wheels on a plane of this gradient along the heading (rise over run), for wheels that
/// stand `along_m` ahead of their middle. On a slope weight moves back by the moment of the weight's part
/// along it about the ground:
///   N_k = m g cos(alpha) (1/n - tan(alpha) h a_k / sum a^2)
/// which for two axles is the textbook's m g sin(alpha) h / L. No wheel carries less than a tenth of its even
/// share: an axle that lifts off is no longer driving. Empty without wheels.
std::vector<double> wheelLoads_N(const Rover& rover, double gradient, const std::vector<double>& along_m);

}  // namespace talus::terramech
