#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Pneumatic tyre on rigid and on soft ground (thesis C.2.2, C.2.3; wong_2001 chapter 2). The tyre flattens
/// if inflation pressure p_i plus carcass pressure p_c is below the critical pressure p_cr, the contact
/// pressure of a rigid wheel.
namespace talus::terramech {

/// Pneumatic tyre with the outer radius and the width of `wheel`.
struct Tyre {
  Wheel wheel;                   ///< undeflected; grousers are ignored
  double inflation_Pa = 0.0;     ///< p_i >= 0
  double carcass_Pa = 0.0;       ///< p_c >= 0, carcass stiffness as an equivalent pressure; p_i + p_c > 0
  double hysteresis = 0.0;       ///< flexing resistance divided by load [-], >= 0
  double friction = 0.7;         ///< friction coefficient mu of the tread on rigid ground [-], >= 0
  double tread_stiffness = 1e8;  ///< shear stress per displacement of the tread [Pa/m], > 0
};

/// Operating mode of a tyre.
enum class TyreMode {
  Flattened,  ///< elastic: flat contact at pressure p_i + p_c
  Rigid       ///< p_i + p_c >= p_cr: behaves as a rigid wheel
};

/// Deformation and forces of a tyre.
struct TyreForces {
  TyreMode mode = TyreMode::Flattened;
  double critical_pressure_Pa = 0.0;  ///< p_cr by criticalPressure_Pa(); 0 on rigid ground
  double sinkage_m = 0.0;             ///< depth of the lowest point; 0 on rigid ground
  double deflection_m = 0.0;          ///< radial deflection of the tyre; 0 in mode Rigid
  double flat_length_m = 0.0;         ///< length of the flat; 0 in mode Rigid
  double torque_Nm = 0.0;
  /// net forward force; flexing adds to torque_Nm and leaves this force unchanged
  double drawbar_pull_N = 0.0;
};

/// Operation of a tyre: load > 0 [N], driven slip in [0, 1].
struct TyreOperation {
  double load_N = 0.0;
  double slip = 0.0;
};

/// Returns the critical pressure [Pa]: the pressure under the lowest point of a rigid wheel of the tyre's
/// size (wong_2001, small angles):
///   p_cr = (k_c/b + k_phi)^{1/(2n+1)} [3 W / ((3 - n) b sqrt D)]^{2n/(2n+1)}.
/// A tyre with p_i + p_c >= p_cr stays round. Throws std::domain_error for n >= 3.
double criticalPressure_Pa(const Soil& soil, const Wheel& wheel, double load_N);

/// Returns the forces on rigid ground. The flat length is l = W / ((p_i + p_c) b) and the deflection r -
/// sqrt(r^2 - l^2/4). The shear stress is that of a brush model of the tread under uniform pressure, tau =
/// min(stiffness i x, mu p) at distance x behind the front. The torque is the shear force times r -
/// deflection, plus flexing resistance hysteresis W times r. Throws std::invalid_argument for a field outside
/// its range, std::domain_error if l >= 2 r.
TyreForces tyreOnRigidGround(const Tyre& tyre, const TyreOperation& operation);

/// Returns the forces on soft ground. If p_i + p_c >= p_cr, the tyre acts as the rigid wheel of
/// wong_reece.hpp. Otherwise the flat carries p_i + p_c at depth z_0 = ((p_i + p_c)/k)^{1/n}, the arc in
/// front of the flat carries Bekker's pressure at the local depth, and the deflection balances the load.
/// Shear stress follows Janosi and Hanamoto over the whole contact; j follows thesis Eq. C.6 along the arc
/// and grows by i per metre along the flat. Throws as tyreOnRigidGround(), criticalPressure_Pa() and
/// equilibrium(), and std::domain_error if no deflection carries the load.
TyreForces tyreOnSoftGround(const Tyre& tyre, const Soil& soil, const TyreOperation& operation);

}  // namespace talus::terramech
