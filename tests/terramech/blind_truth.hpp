#pragma once

#include "blind_worlds.hpp"

/// The wheel of the made-up worlds: Wong and Reece's integrals by the midpoint rule, with the hidden effects.
namespace talus::blind {

/// One row as it is driven, SI.
struct Conditions {
  double load, slip, speed, rim, pass, time, slope, grouser, temperature, dust, battery, radius, width;
  double strength = 1.0, stiffness = 1.0;  // of the soil there, over that of the world
};

/// What the sensors of a wheel would read without noise, SI.
struct Answer {
  double z, torque, pull;
};

/// The sinkage, torque and drawbar pull of a wheel in the world under these conditions.
Answer truth(const World& world, const Conditions& at);

}  // namespace talus::blind
