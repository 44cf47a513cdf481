#pragma once

#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Sinkage and forces of a rigid wheel on soft soil (wong_reece_1967a, wong_reece_1967b; thesis appendix
/// C.1), including travel at an angle to the wheel plane (ishigami_2007).
namespace talus::terramech {

struct Tangent;

/// Load, slip and direction of travel of a wheel.
struct WheelOperation {
  double load_N = 0.0;  ///< vertical load W > 0
  double slip = 0.0;    ///< in [-1, 1]: driven 1 - v/(r omega) >= 0, braked r omega/v - 1 < 0, locked -1
  /// Rebound kappa in [0, 0.999] [-]: behind the wheel the soil recovers by kappa z, and the contact ends at
  /// the exit angle theta_2 = -acos(1 - kappa z/r). With kappa = 0 the contact ends below the axle, theta_2 =
  /// 0 (thesis).
  double rebound = 0.0;
  /// Slip angle beta in [-pi/2, pi/2], from the wheel plane to the direction of travel, positive to the left.
  /// The slip above is that along the wheel plane, i.e. with v cos beta in place of v. At beta = 0 the result
  /// is bit-identical to that of the model without a slip angle.
  double slip_angle_rad = 0.0;
  /// Gravity > 0; gives the weight of the soil pushed aside, used only if beta is not 0.
  double gravity_m_s2 = 9.80665;
};

/// Sinkage of a wheel and forces of the soil on the wheel.
struct WheelForces {
  double sinkage_m = 0.0;        ///< sinkage z = r (1 - cos theta_1)
  double entry_angle_rad = 0.0;  ///< entry angle theta_1 of the contact
  double torque_Nm = 0.0;        ///< drive torque at the given slip; negative when braking
  /// Force along the wheel plane that is available for slope and towing; negative if resistance exceeds
  /// thrust.
  double drawbar_pull_N = 0.0;
  /// Force across the wheel plane, opposite to the sideways motion: negative for slip_angle_rad > 0.
  double side_force_N = 0.0;
};

/// Stress law of Wong and Reece, which satisfies the concept ContactLaw of rim_contact.hpp. Normal stress
/// sigma at the depth h, angle theta_m of the stress peak, and shear stress tau at the shear displacement j:
///   sigma(h) = (k_c/b + k_phi) h^n                        (thesis C.4)
///   theta_m = (c1 + c2 i) theta_1                         (C.2)
///   tau(sigma, j) = (c + sigma tan phi)(1 - e^{-j/K})     (C.7), odd in j
/// Lugs multiply c and tan phi by shearGain(). Soil::slip_sinkage_exponent increases n with slip. At a slip
/// angle, tau acts along the resultant displacement of magnitude j = hypot(j_x, j_y), and
/// Soil::digging_exponent increases n. (ishigami_2007 evaluates tau_x and tau_y separately, so that their
/// resultant can exceed the strength.)
class WongReece {
 public:
  /// Throws std::invalid_argument if a field or k_c/b + k_phi is outside its range. Throws std::domain_error
  /// if the stress peak is outside the contact, i.e. if c1 + c2 i is outside [0, 1].
  WongReece(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

  /// Returns the normal stress sigma [Pa] at the depth h = depth_m >= 0.
  double pressure_Pa(double depth_m) const;
  /// Returns the shear stress tau [Pa] at the normal stress sigma = normal_Pa and the shear displacement j =
  /// displacement_m. The second overload takes and returns components along and across the wheel plane.
  double shear_Pa(double normal_Pa, double displacement_m) const;
  Tangent shear_Pa(double normal_Pa, const Tangent& displacement_m) const;
  /// Returns the angle theta_m [rad] of the stress peak at the entry angle theta_1 = entry_rad.
  double peak_rad(double entry_rad) const { return peak_fraction_ * entry_rad; }
  /// Returns the exit angle theta_2 <= 0 [rad] at the entry angle theta_1 = entry_rad.
  double exit_rad(double entry_rad) const;

  /// Returns an entry angle [rad] as initial value of a search. At this angle the normal stress alone carries
  /// the load [N], to first order in the angle.
  double smallAngleEntry_rad(double load_N) const;

 private:
  double modulus_, exponent_, cohesion_Pa_, tan_friction_, shear_modulus_m_;
  double peak_fraction_, rebound_;
  double radius_m_, width_m_;
};

/// Returns sinkage and forces of a wheel that carries the load at the given slip and slip angle. The side
/// force is the shear force on the rim plus the bulldozing force -Soil::side_bulldozing sin beta
/// faceResistance_N(). The relative accuracy is 1e-8 for n from 0.1 to 2 and theta_1 up to pi/2, and 1e-6 for
/// a braked wheel at a slip angle; the errors of drawbar pull and side force are relative to the load. Throws
/// std::invalid_argument for a field outside its range. Throws std::domain_error if the wheel carries less
/// than the load at theta_1 = pi/2, or if the stress peak is outside the contact. Thread-safe.
WheelForces equilibrium(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// Forces on a wheel at an imposed entry angle.
struct ImposedContact {
  double load_N = 0.0;  ///< vertical force of the soil on the wheel at this entry angle
  WheelForces forces;   ///< sinkage and forces at this entry angle
};

/// Returns the forces on a wheel at the entry angle theta_1 = entry_rad in (0, pi/2]. WheelOperation::load_N
/// is not used. Throws the exceptions of equilibrium().
ImposedContact forcesAtEntry(const Soil& soil, const Wheel& wheel, const WheelOperation& operation,
                             double entry_rad);

/// Stresses of the soil at one angle of the rim, along the wheel plane.
struct RimStress {
  double angle_rad = 0.0;  ///< rim angle theta from the downward vertical, positive forward
  double normal_Pa = 0.0;  ///< normal stress sigma
  double shear_Pa = 0.0;   ///< shear stress tau
  /// Shear displacement j along the wheel plane; minus infinity for a locked wheel.
  double displacement_m = 0.0;
};

/// Returns the stresses along the wheel plane at `count` >= 2 equally spaced rim angles from the exit angle
/// theta_2 to the entry angle theta_1, for plots (thesis Figs. 2.2, C.3, C.4). Throws the exceptions of
/// equilibrium().
std::vector<RimStress> stressDistribution(const Soil& soil, const Wheel& wheel,
                                          const WheelOperation& operation, int count = 101);

}  // namespace talus::terramech
