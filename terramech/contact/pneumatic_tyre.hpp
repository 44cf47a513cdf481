#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// A pneumatic tyre on rigid and on soft ground (thesis C.2.2, C.2.3; wong_2001 chapter 2): it flattens where
/// the pressure that it can bear, inflation plus carcass, is below what the ground gives back to a rigid
/// wheel.
namespace talus::terramech {

/// A tyre of the outer radius and width of a wheel.
struct Tyre {
  Wheel wheel;                   ///< undeflected; grousers are not used
  double inflation_Pa = 0.0;     ///< p_i >= 0
  double carcass_Pa = 0.0;       ///< p_c >= 0, stiffness of the carcass as a pressure; p_i + p_c > 0
  double hysteresis = 0.0;       ///< resistance of flexing over the load [-], >= 0
  double friction = 0.7;         ///< mu of the tread on rigid ground [-], >= 0
  double tread_stiffness = 1e8;  ///< shear stress over displacement of the tread [Pa/m], > 0
};

/// How a tyre meets the ground.
enum class TyreMode {
  Flattened,  ///< elastic: a flat at inflation plus carcass pressure
  Rigid       ///< stiffer than the ground: a rigid wheel
};

/// What the ground does to a tyre.
struct TyreForces {
  TyreMode mode = TyreMode::Flattened;
  double critical_pressure_Pa = 0.0;  ///< of criticalPressure_Pa(); 0 on rigid ground
  double sinkage_m = 0.0;             ///< of its lowest point; 0 on rigid ground
  double deflection_m = 0.0;          ///< of the tyre; 0 when it stays round
  double flat_length_m = 0.0;         ///< of the flattened contact
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;  ///< thrust less resistance of the ground and of flexing
};

/// Load > 0 [N] and driven slip [0, 1].
struct TyreOperation {
  double load_N = 0.0;
  double slip = 0.0;
};

/// The pressure under the lowest point of a rigid wheel of the tyre's size (wong_2001, small angles):
///   p_cr = (k_c/b + k_phi)^{1/(2n+1)} [3 W / ((3 - n) b sqrt D)]^{2n/(2n+1)}.
/// A tyre with p_i + p_c above it stays round. Throws std::domain_error for n >= 3.
double criticalPressure_Pa(const Soil& soil, const Wheel& wheel, double load_N);

/// On rigid ground: flat length l = W / ((p_i + p_c) b), deflection r - sqrt(r^2 - l^2/4), shear of a brush
/// of tread under even pressure, tau = min(stiffness i x, mu p) at x behind the front; flexing resists with
/// hysteresis x W. The torque is the shear on the arm r - deflection, and flexing on r. Throws
/// std::invalid_argument for a field outside its range, std::domain_error when the tyre would flatten over
/// its whole diameter.
TyreForces tyreOnRigidGround(const Tyre& tyre, const TyreOperation& operation);

/// On soft ground. Rigid where p_i + p_c >= p_cr: the wheel of wong_reece.hpp. Else the flat carries p_i +
/// p_c, its depth is z_0 = ((p_i + p_c)/k)^{1/n}, the round part in front of it Bekker's pressure at its
/// depth; the deflection is what balances the load. Shear by Janosi and Hanamoto over the whole contact:
/// along the round part thesis C.6, along the flat j grows by i per metre. Errors as above and as
/// equilibrium().
TyreForces tyreOnSoftGround(const Tyre& tyre, const Soil& soil, const TyreOperation& operation);

}  // namespace talus::terramech
