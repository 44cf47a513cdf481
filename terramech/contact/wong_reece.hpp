#pragma once

#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// A rigid wheel on soft soil (wong_reece_1967a, wong_reece_1967b; thesis appendix C.1), also where it
/// travels at an angle to its plane (ishigami_2007).
namespace talus::terramech {

struct Tangent;

/// How a wheel is used.
struct WheelOperation {
  double load_N = 0.0;  ///< vertical load > 0
  double slip = 0.0;    ///< [-1, 1]: driven 1 - v/(r omega) >= 0, braked r omega/v - 1 < 0, locked -1
  /// Kappa in [0, 1): the soil springs back by kappa z behind the wheel, so that contact ends at theta_2 =
  /// -acos(1 - kappa z/r); 0 ends it under the axle (theta_2 = 0, as the thesis).
  double rebound = 0.0;
  /// Beta in [-pi/2, pi/2], from the wheel plane to the travel, left positive; 0 has the bits of the straight
  /// wheel. The slip is along the wheel plane: v cos beta counts.
  double slip_angle_rad = 0.0;
  double gravity_m_s2 = 9.80665;  ///< > 0: the weight of soil pushed aside; acts only where beta is not 0
};

/// What the soil does to a wheel.
struct WheelForces {
  double sinkage_m = 0.0;        ///< z = r (1 - cos theta_1)
  double entry_angle_rad = 0.0;  ///< theta_1
  double torque_Nm = 0.0;        ///< that holds the slip; negative when braking
  double drawbar_pull_N =
      0.0;  ///< along the wheel plane, left for slope and load; negative when resistance wins
  double side_force_N = 0.0;  ///< across it, against the sideways motion: negative for slip_angle_rad > 0
};

/// Bekker pressure, Wong-Reece peak, Janosi-Hanamoto shear: the ContactLaw of rim_contact.hpp.
///   sigma(h) = (k_c/b + k_phi) h^n                        (thesis C.4)
///   theta_m = (c1 + c2 i) theta_1                         (C.2)
///   tau(sigma, j) = (c + sigma tan phi)(1 - e^{-j/K})     (C.7), odd in j; c and tan phi times shearGain() of lugs
/// and of a wheel that slides sideways tau along the resultant displacement j = hypot(j_x, j_y)
/// (ishigami_2007 takes the two apart, which can exceed the strength), n raised by Soil::digging_exponent; with slip by Soil::slip_sinkage_exponent.
class WongReece {
 public:
  /// Throws std::invalid_argument when a field or k_c/b + k_phi leaves its range; std::domain_error when the
  /// stress peak c1 + c2 i leaves [0, 1], the contact.
  WongReece(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

  double pressure_Pa(double depth_m) const;
  double shear_Pa(double normal_Pa, double displacement_m) const;
  Tangent shear_Pa(double normal_Pa, const Tangent& displacement_m) const;
  double peak_rad(double entry_rad) const { return peak_fraction_ * entry_rad; }
  double exit_rad(double entry_rad) const;

  /// Entry angle that carries the load to first order in the angle and without shear [rad], to start a search
  /// from.
  double smallAngleEntry_rad(double load_N) const;

 private:
  double modulus_, exponent_, cohesion_Pa_, tan_friction_, shear_modulus_m_;
  double peak_fraction_, rebound_;
  double radius_m_, width_m_;
};

/// Sinkage and forces of a wheel that carries the load at the slip and slip angle. Side force: shear of the
/// rim and Soil::side_bulldozing sin beta times faceResistance_N(). Relative accuracy 1e-8 (drawbar pull and
/// side force: of the load; 1e-6 of a braked wheel at a slip angle) over n 0.1 to 2, theta_1 to pi/2. Throws
/// std::invalid_argument for a field outside its range and std::domain_error when the wheel would sink to its
/// axle or the stress peak would leave the contact. Thread-safe.
WheelForces equilibrium(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// Forces at a forced sinkage, whatever the load. `load_N` of the operation is not used.
struct ImposedContact {
  double load_N = 0.0;  ///< that the soil carries at this entry angle
  WheelForces forces;
};

/// Forces on a wheel pressed in to entry angle theta_1 in (0, pi/2]; errors as equilibrium().
ImposedContact forcesAtEntry(const Soil& soil, const Wheel& wheel, const WheelOperation& operation,
                             double entry_rad);

/// Stresses at one angle of the rim.
struct RimStress {
  double angle_rad = 0.0;       ///< theta from the downward vertical, forward positive
  double normal_Pa = 0.0;       ///< sigma
  double shear_Pa = 0.0;        ///< tau
  double displacement_m = 0.0;  ///< j; minus infinity for a locked wheel
};

/// Stresses along the wheel plane at `count` >= 2 angles equally spaced from theta_2 to theta_1, for plotting
/// (thesis Figs. 2.2, C.3, C.4).
std::vector<RimStress> stressDistribution(const Soil& soil, const Wheel& wheel,
                                          const WheelOperation& operation, int count = 101);

}  // namespace talus::terramech
