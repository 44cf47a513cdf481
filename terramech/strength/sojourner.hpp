#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Wheel spin of the Sojourner rover: a wheel turned in place, with uniform stresses over the chord (thesis
/// App. B.2; moore_1999).
namespace talus::terramech {

/// Returns sigma = W/A, tau = T/(r A), A = 2 b sqrt(2 r z - z^2) (thesis Eq. B.1), for MohrCoulombLine. The
/// slip is not used: the shear is assumed to be fully mobilised. Throws std::invalid_argument unless 0 <
/// sinkage < 2 r.
StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample);

}  // namespace talus::terramech
