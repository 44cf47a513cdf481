#pragma once

#include <talus/terramech/contact/wheel.hpp>

/// Drawbar pull of a rigid wheel on rigid flat ground (thesis C.2.1).
namespace talus::terramech {

/// Coefficients of Coulomb friction between a wheel and rigid ground.
struct GroundFriction {
  double static_coefficient = 0.7;   ///< static friction coefficient mu_s >= mu_k [-]
  double kinetic_coefficient = 0.6;  ///< kinetic friction coefficient mu_k >= 0 [-]
};

/// Result of rigidGroundForces() for a wheel at a given torque.
struct RigidGroundForces {
  double drawbar_pull_N = 0.0;  ///< drawbar pull DP, with the sign of the torque
  bool slips = false;           ///< true: the torque exceeds static friction and the wheel slips
};

/// Returns the drawbar pull DP of a wheel under the load W = load_N > 0 at the torque T = torque_Nm (thesis
/// Eq. C.11). If |T|/r <= mu_s W, then DP = T/r. Otherwise the wheel slips and DP = mu_k W with the sign of
/// T. Throws std::invalid_argument if the wheel, the load or a friction coefficient is outside its range.
RigidGroundForces rigidGroundForces(const Wheel& wheel, const GroundFriction& friction, double load_N,
                                    double torque_Nm);

}  // namespace talus::terramech
