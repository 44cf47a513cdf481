#pragma once

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Returns the entry angle theta_1 = arccos(1 - z/r) [rad], in [0, pi), of a wheel of radius r at the sinkage
/// z = sinkage_m. The entry angle is the angle between the downward vertical and the front end of the
/// contact. The formula is evaluated as 2 arcsin(sqrt(z / 2r)), which does not cancel at small z. Throws
/// std::invalid_argument unless radius_m > 0 and 0 <= sinkage_m < 2 r.
double entryAngle_rad(const Wheel& wheel, double sinkage_m);

/// Returns the sinkage z = r (1 - cos theta_1) [m] of a wheel at the entry angle theta_1 [rad]. This function
/// is the inverse of entryAngle_rad().
double sinkage_m(const Wheel& wheel, double entry_angle_rad);

/// Returns the length 2 sqrt(2 r z - z^2) [m] of the chord at which the soil surface cuts a wheel of sinkage
/// z that is spun in place (thesis Eq. B.1). Throws the exceptions of entryAngle_rad().
double contactChord_m(const Wheel& wheel, double sinkage_m);

}  // namespace talus::terramech
