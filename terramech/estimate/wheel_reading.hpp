#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// Telemetry sample with its wheel, for tables with several wheel sizes.
struct WheelReading {
  Wheel wheel;
  WheelSample sample;  ///< readings of this wheel
};

}  // namespace talus::terramech
