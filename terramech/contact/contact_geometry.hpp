#pragma once

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Returns the entry angle theta_1 = arccos(1 - z/r) [rad], in [0, pi), at sinkage z = sinkage_m. The code
/// evaluates 2 arcsin(sqrt(z / 2r)), which does not cancel at small z. Throws std::invalid_argument unless
/// radius_m > 0 and 0 <= sinkage_m < 2 r.
double entryAngle_rad(const Wheel& wheel, double sinkage_m);

/// Returns the sinkage z = r (1 - cos theta_1) [m] at entry angle theta_1 [rad]; the inverse of
/// entryAngle_rad().
double sinkage_m(const Wheel& wheel, double entry_angle_rad);

/// Returns the contact chord of a wheel spun in place, 2 sqrt(2 r z - z^2) [m] (thesis Eq. B.1). Throws as
/// entryAngle_rad().
double contactChord_m(const Wheel& wheel, double sinkage_m);

}  // namespace talus::terramech
