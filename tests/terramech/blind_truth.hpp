#pragma once

#include "blind_worlds.hpp"

/// Wheel model of the synthetic worlds: Wong and Reece's integrals by the midpoint rule, with the hidden
/// effects.
namespace talus::blind {

/// Conditions of one row, in SI units.
struct Conditions {
  double load, slip, speed, rim, pass, time, slope, grouser, temperature, dust, battery, radius, width;
  double strength = 1.0, stiffness = 1.0;  // factors on the soil of the world at the row
};

/// Noise-free readings of a wheel, in SI units.
struct Answer {
  double z, torque, pull;
};

/// Sinkage, torque and drawbar pull of a wheel of the world under these conditions.
Answer truth(const World& world, const Conditions& at);

}  // namespace talus::blind
