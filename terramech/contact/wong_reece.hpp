#pragma once

#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Rigid wheel on soft soil (wong_reece_1967a, wong_reece_1967b; thesis appendix C.1), including travel at an
/// angle to the wheel plane (ishigami_2007).
namespace talus::terramech {

struct Tangent;

/// Operating condition of a wheel.
struct WheelOperation {
  double load_N = 0.0;  ///< vertical load > 0
  double slip = 0.0;    ///< [-1, 1]: driven 1 - v/(r omega) >= 0, braked r omega/v - 1 < 0, locked -1
  /// Rebound kappa in [0, 0.999] [-]: the soil recovers by kappa z behind the wheel and contact ends at
  /// theta_2 = -acos(1 - kappa z/r). 0: contact ends below the axle (theta_2 = 0, as in the thesis).
  double rebound = 0.0;
  /// Slip angle beta in [-pi/2, pi/2], from the wheel plane to the direction of travel, left positive. The
  /// slip is along the wheel plane, with v cos beta for v. At 0 the result is bit-identical to the straight
  /// wheel.
  double slip_angle_rad = 0.0;
  double gravity_m_s2 = 9.80665;  ///< > 0; weight of the soil pushed aside, used only if beta is not 0
};

/// Sinkage and forces of a wheel.
struct WheelForces {
  double sinkage_m = 0.0;        ///< z = r (1 - cos theta_1)
  double entry_angle_rad = 0.0;  ///< theta_1
  double torque_Nm = 0.0;        ///< drive torque at the given slip; negative when braking
  double drawbar_pull_N =
      0.0;  ///< along the wheel plane, available for slope and towing; negative if resistance exceeds thrust
  /// Across the wheel plane, opposite to the sideways motion: negative for slip_angle_rad > 0.
  double side_force_N = 0.0;
};

/// Contact law of Wong and Reece; a ContactLaw of rim_contact.hpp.
///   sigma(h) = (k_c/b + k_phi) h^n                        (thesis C.4)
///   theta_m = (c1 + c2 i) theta_1                         (C.2)
///   tau(sigma, j) = (c + sigma tan phi)(1 - e^{-j/K})     (C.7), odd in j
/// Lugs multiply c and tan phi by shearGain(). Soil::slip_sinkage_exponent increases n with slip. At a slip
/// angle tau acts along the resultant displacement j = hypot(j_x, j_y), and Soil::digging_exponent increases
/// n. (ishigami_2007 evaluates tau_x and tau_y separately; their resultant can exceed the strength.)
class WongReece {
 public:
  /// Throws std::invalid_argument if a field or k_c/b + k_phi is outside its range, std::domain_error if the
  /// stress peak c1 + c2 i is outside the contact, [0, 1].
  WongReece(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

  /// Returns sigma [Pa] at depth h >= 0 [m].
  double pressure_Pa(double depth_m) const;
  /// Returns tau [Pa] at normal stress sigma [Pa] and shear displacement j [m], and its components for a
  /// displacement with components.
  double shear_Pa(double normal_Pa, double displacement_m) const;
  Tangent shear_Pa(double normal_Pa, const Tangent& displacement_m) const;
  /// Returns theta_m [rad] at entry angle theta_1 [rad].
  double peak_rad(double entry_rad) const { return peak_fraction_ * entry_rad; }
  /// Returns theta_2 <= 0 [rad] at entry angle theta_1 [rad].
  double exit_rad(double entry_rad) const;

  /// Returns an initial entry angle [rad] for a search: carries the load to first order in the angle, without
  /// shear.
  double smallAngleEntry_rad(double load_N) const;

 private:
  double modulus_, exponent_, cohesion_Pa_, tan_friction_, shear_modulus_m_;
  double peak_fraction_, rebound_;
  double radius_m_, width_m_;
};

/// Returns sinkage and forces of a wheel that carries the load at the given slip and slip angle. The side
/// force is the shear force on the rim plus -Soil::side_bulldozing sin beta faceResistance_N(). Relative
/// accuracy 1e-8 over n 0.1 to 2 and theta_1 to pi/2; drawbar pull and side force relative to the load; 1e-6
/// for a braked wheel at a slip angle. Throws std::invalid_argument for a field outside its range,
/// std::domain_error if the load is not carried at theta_1 = pi/2 or the stress peak is outside the contact.
/// Thread-safe.
WheelForces equilibrium(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// Forces at an imposed entry angle, and the load that they carry.
struct ImposedContact {
  double load_N = 0.0;  ///< vertical force of the soil at this entry angle
  WheelForces forces;
};

/// Returns the forces on a wheel at entry angle theta_1 in (0, pi/2]. The load_N of the operation is not
/// used. Throws as equilibrium().
ImposedContact forcesAtEntry(const Soil& soil, const Wheel& wheel, const WheelOperation& operation,
                             double entry_rad);

/// Stresses at one angle of the rim, along the wheel plane.
struct RimStress {
  double angle_rad = 0.0;       ///< theta from the downward vertical, positive forward
  double normal_Pa = 0.0;       ///< sigma
  double shear_Pa = 0.0;        ///< tau
  double displacement_m = 0.0;  ///< j along the wheel plane; minus infinity for a locked wheel
};

/// Returns the stresses along the wheel plane at `count` >= 2 equally spaced angles from theta_2 to theta_1,
/// for plots (thesis Figs. 2.2, C.3, C.4). Throws as equilibrium().
std::vector<RimStress> stressDistribution(const Soil& soil, const Wheel& wheel,
                                          const WheelOperation& operation, int count = 101);

}  // namespace talus::terramech
