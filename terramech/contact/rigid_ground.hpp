#pragma once

#include <talus/terramech/contact/wheel.hpp>

/// A rigid wheel on rigid flat ground (thesis C.2.1).
namespace talus::terramech {

/// Dry friction between a wheel and hard ground.
struct GroundFriction {
  double static_coefficient = 0.7;   ///< mu_s >= mu_k [-]
  double kinetic_coefficient = 0.6;  ///< mu_k >= 0 [-]
};

/// What a torque does on hard ground.
struct RigidGroundForces {
  double drawbar_pull_N = 0.0;  ///< signed as the torque
  bool slips = false;
};

/// Thesis C.11: DP = T/r while |T|/r <= mu_s W, else mu_k W (signed as T) and the wheel slips. Throws
/// std::invalid_argument when the wheel, the load [N] > 0 or the friction leaves its range.
RigidGroundForces rigidGroundForces(const Wheel& wheel, const GroundFriction& friction, double load_N,
                                    double torque_Nm);

}  // namespace talus::terramech
