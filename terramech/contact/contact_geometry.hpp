#pragma once

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Entry angle theta_1 [rad], in [0, pi): arccos(1 - z/r), as 2 arcsin(sqrt(z / 2r)), which keeps its digits
/// at small z. Throws std::invalid_argument unless 0 <= sinkage_m < 2 r.
double entryAngle_rad(const Wheel& wheel, double sinkage_m);

/// Sinkage z = r (1 - cos theta_1) [m] of an entry angle [rad]; the inverse of entryAngle_rad().
double sinkage_m(const Wheel& wheel, double entry_angle_rad);

/// Chord of the contact of a wheel spun in place, 2 sqrt(2 r z - z^2) [m] (thesis Eq. B.1).
double contactChord_m(const Wheel& wheel, double sinkage_m);

}  // namespace talus::terramech
