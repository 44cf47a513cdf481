#pragma once

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Forces on a pneumatic tyre on rigid and on soft ground (thesis C.2.2, C.2.3; wong_2001 chapter 2). The
/// tyre flattens if the sum of inflation pressure p_i and carcass pressure p_c is below the critical pressure
/// p_cr, the contact pressure of a rigid wheel of the same size.

/// Returns the pressure p = (k_c/b + k_phi) z^n [Pa] (Bekker, thesis Eq. A.1; bekker_1969) under a plate or
/// wheel whose smaller dimension is b = width_m > 0, at the depth z = depth_m >= 0.
double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Bekker's pressure equals pressure_Pa >= 0, for the smaller dimension b =
/// width_m. Throws std::domain_error if k_c/b + k_phi <= 0 and std::invalid_argument if pressure_Pa < 0.
double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa);

/// Pneumatic tyre. Its undeflected outer radius r and its width b are those of `wheel`.
struct Tyre {
  Wheel wheel;                ///< radius and width of the undeflected tyre; grousers are ignored
  double inflation_Pa = 0.0;  ///< inflation pressure p_i >= 0
  /// Carcass pressure p_c >= 0: carcass stiffness as an equivalent pressure; p_i + p_c > 0.
  double carcass_Pa = 0.0;
  double hysteresis = 0.0;       ///< flexing resistance divided by load [-], >= 0
  double friction = 0.7;         ///< friction coefficient mu of the tread on rigid ground [-], >= 0
  double tread_stiffness = 1e8;  ///< shear stress per displacement of the tread [Pa/m], > 0
};

/// Operating mode of a tyre on soft ground.
enum class TyreMode {
  Flattened,  ///< the tyre is flat at the bottom, with contact pressure p_i + p_c
  Rigid       ///< p_i + p_c >= p_cr: the tyre stays round and acts as a rigid wheel
};

/// Deformation and forces of a tyre.
struct TyreForces {
  TyreMode mode = TyreMode::Flattened;
  double critical_pressure_Pa = 0.0;  ///< p_cr of criticalPressure_Pa(); 0 on rigid ground
  double sinkage_m = 0.0;             ///< depth of the lowest point of the tyre; 0 on rigid ground
  double deflection_m = 0.0;          ///< radial deflection of the tyre; 0 in mode Rigid
  double flat_length_m = 0.0;         ///< length of the flat part of the contact; 0 in mode Rigid
  double torque_Nm = 0.0;             ///< drive torque about the axle
  /// Net forward force. Flexing of the tyre adds to torque_Nm but leaves this force unchanged.
  double drawbar_pull_N = 0.0;
};

/// Load and slip of a tyre.
struct TyreOperation {
  double load_N = 0.0;  ///< vertical load W > 0
  double slip = 0.0;    ///< driven slip i in [0, 1] [-]
};

/// Returns the critical pressure [Pa] of a tyre under the load W = load_N: the pressure under the lowest
/// point of a rigid wheel of the tyre's size (wong_2001, small angles). With tyre diameter D = 2 r:
///   p_cr = (k_c/b + k_phi)^{1/(2n+1)} [3 W / ((3 - n) b sqrt D)]^{2n/(2n+1)}.
/// A tyre with p_i + p_c >= p_cr stays round. Throws std::domain_error for a sinkage exponent n >= 3.
double criticalPressure_Pa(const Soil& soil, const Wheel& wheel, double load_N);

/// Returns the forces on a tyre on rigid ground. The flat part has the length l = W / ((p_i + p_c) b), and
/// the tyre deflection is r - sqrt(r^2 - l^2/4). The shear stress is that of a brush model of the tread under
/// uniform pressure: tau = min(tread_stiffness i x, mu p) at the distance x behind the front end of the
/// contact, with p = p_i + p_c and mu = friction. The torque is the shear force times (r - deflection), plus
/// the flexing resistance, hysteresis W, times r. Throws std::invalid_argument for a field outside its range
/// and std::domain_error if l >= 2 r.
TyreForces tyreOnRigidGround(const Tyre& tyre, const TyreOperation& operation);

/// Returns the forces on a tyre on soft ground. If p_i + p_c >= p_cr, the tyre acts as the rigid wheel of
/// wheel_on_soil.hpp. Otherwise the flat part carries the pressure p_i + p_c at the depth z_0 = ((p_i +
/// p_c)/k)^{1/n}, the round part in front of the flat part carries Bekker's pressure at the local depth, and
/// the tyre deflection is the one at which the sum equals the load. The shear stress follows the law of
/// Janosi and Hanamoto over the whole contact. The shear displacement j follows thesis Eq. C.6 along the
/// round part and increases by i per metre along the flat part. Throws the exceptions of tyreOnRigidGround(),
/// criticalPressure_Pa() and equilibrium(), and std::domain_error if no deflection carries the load.
TyreForces tyreOnSoftGround(const Tyre& tyre, const Soil& soil, const TyreOperation& operation);

/// Drawbar pull of a rigid wheel on rigid flat ground (thesis C.2.1).

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
