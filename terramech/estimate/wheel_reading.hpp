#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// A sample and the wheel it was read on, where a table holds wheels of several sizes.
struct WheelReading {
  Wheel wheel;
  WheelSample sample;
};

}  // namespace talus::terramech
