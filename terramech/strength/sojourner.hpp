#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Sojourner's wheel spin: a wheel turned in place, stresses taken uniform over the chord (thesis App. B.2;
/// moore_1999).
namespace talus::terramech {

/// sigma = W/A, tau = T/(r A), A = 2 b sqrt(2 r z - z^2) (thesis Eq. B.1); feed it to MohrCoulombLine.
/// Throws std::invalid_argument unless 0 < sinkage < 2 r. Slip is not used: the shear is taken as fully
/// developed.
StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample);

}  // namespace talus::terramech
