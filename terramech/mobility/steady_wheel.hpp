#pragma once

#include <algorithm>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {

/// Returns the state of a wheel of a rover in steady motion. For a slip s >= 0 the rim speed is the rover's
/// maximum speed v and the travel speed is v (1 - s). For s < 0 (braking) the rim speed is v (1 + s) and the
/// travel speed is v. Pass number and slope of the state are unknown.
inline WheelState steadyWheel(const Rover& rover, double load_N, double slip, double slip_angle_rad = 0.0) {
  WheelState state;
  state.wheel = rover.wheel;
  state.load_N = load_N;
  state.slip = slip;
  state.slip_angle_rad = slip_angle_rad;
  state.rim_speed_mps = rover.max_speed_mps * (1.0 + std::min(slip, 0.0));
  state.speed_mps = rover.max_speed_mps * (1.0 - std::max(slip, 0.0));
  state.gravity_m_s2 = rover.gravity_m_s2;
  return state;
}

}  // namespace talus::terramech
