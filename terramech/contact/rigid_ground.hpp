#pragma once

#include <talus/terramech/contact/wheel.hpp>

/// A rigid wheel on rigid flat ground (thesis C.2.1).
namespace talus::terramech {

/// Coulomb friction between a wheel and rigid ground.
struct GroundFriction {
  double static_coefficient = 0.7;   ///< mu_s >= mu_k [-]
  double kinetic_coefficient = 0.6;  ///< mu_k >= 0 [-]
};

/// Forces of a wheel on rigid ground at a given torque.
struct RigidGroundForces {
  double drawbar_pull_N = 0.0;  ///< same sign as the torque
  bool slips = false;
};

/// Returns the drawbar pull (thesis Eq. C.11): DP = T/r if |T|/r <= mu_s W; otherwise the wheel slips and DP
/// = mu_k W with the sign of T. Throws std::invalid_argument if the wheel, the load [N] > 0 or a friction
/// coefficient is outside its range.
RigidGroundForces rigidGroundForces(const Wheel& wheel, const GroundFriction& friction, double load_N,
                                    double torque_Nm);

}  // namespace talus::terramech
