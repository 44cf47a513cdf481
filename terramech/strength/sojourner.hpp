#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Wheel-spin test of the Sojourner rover: a wheel is turned in place, and the stresses are assumed uniform
/// over the chord of the contact (thesis App. B.2; moore_1999).
namespace talus::terramech {

/// Returns the normal stress sigma = W/A and the shear stress tau = T/(r A) of a sample, with A = 2 b sqrt(2
/// r z - z^2) (thesis Eq. B.1). The result is input of MohrCoulombLine. The slip is not used, because the
/// shear strength is assumed to be fully mobilised. Throws std::invalid_argument unless 0 < sinkage < 2 r.
StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample);

}  // namespace talus::terramech
