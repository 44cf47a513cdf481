#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// Expected value and standard deviation of an uncertain quantity, both in the unit of the quantity.
struct Estimate {
  double value = 0.0;
  double std = 0.0;
};

/// Rigid wheel, smooth or with grousers (lugs). The grouser tips are at the radius radius_m +
/// grouser_height_m.
struct Wheel {
  double radius_m = 0.1;          ///< wheel radius r, in [1e-4, 10]
  double width_m = 0.1;           ///< wheel width b, in [1e-4, 10]
  double grouser_height_m = 0.0;  ///< grouser height h, in [0, 1]; 0 for a smooth wheel
  int grouser_count = 0;          ///< number of grousers, 0 to 1000
  /// Fraction of Bekker's shear force on the side faces of the lugs that shearGain() includes, in [0, 5] [-];
  /// 0 for a smooth wheel.
  double lug_thrust = 0.0;

  bool operator==(const Wheel&) const = default;
};

/// Default lug_thrust for a rover file that contains no value [-]: 1 (bekker_1969), with standard deviation
/// 0.5 (ours).
inline constexpr double kLugThrust = 1.0;

/// Returns the factor by which lugs increase the shear strength along the rim [-]: 1 + lug_thrust 0.64 (h/b)
/// atan(b/h) (bekker_1969, number unverified). The reason is that the soil between the lugs also shears along
/// its sides. Returns 1 without lugs.
double shearGain(const Wheel& wheel) noexcept;

/// Throws std::invalid_argument that names field, value and bound if a field is outside its range.
void validate(const Wheel& wheel);

/// Homogeneous soil with Bekker's pressure-sinkage relation, and Janosi and Hanamoto's shear stress. Plain
/// data in SI units.
struct Soil {
  std::string name;                 ///< name of the soil in reports and errors
  double cohesion_Pa = 0.0;         ///< cohesion c, in [0, 1e9]
  double friction_angle_rad = 0.0;  ///< friction angle phi, in [0, pi/2)
  double sinkage_exponent = 1.0;    ///< sinkage exponent n, in [1e-3, 100] [-]
  /// k_c [N/m^(n+1)]; may be negative as long as k_c/b + k_phi > 0 for the wheel width b
  double cohesive_modulus = 0.0;
  double frictional_modulus = 0.0;  ///< k_phi [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K, in [1e-9, 1000]
  /// Ratio theta_m / theta_1 (stress-peak angle over entry angle) at slip 0 [-], finite (wong_reece_1967a).
  double c1 = 0.43;
  double c2 = 0.32;               ///< increase of theta_m / theta_1 per unit slip [-], finite
  double density_kg_m3 = 1600.0;  ///< bulk density of the soil, in [0.1, 1e6]
  /// Slip-sinkage exponent n1 in [0, 2] [-]: at slip i the sinkage exponent is n + n1 |i| (ding_2010: n1 =
  /// 0.2 to 0.6, number unverified). With n1 = 0 there is no slip sinkage, which is the model of the thesis.
  double slip_sinkage_exponent = 0.0;
  /// Digging exponent n_d in [0, 2] [-] of a wheel that slides sideways: the sinkage exponent increases by
  /// n_d (s_R - |i|), with the resultant slip s_R = resultantSlip(). Form and magnitude are those of
  /// ding_2010's slip-sinkage exponent (0.2 to 0.6, number unverified); the use of the resultant slip is
  /// ours.
  double digging_exponent = 0.4;
  /// Factor >= 0 on Hegedus' bulldozing resistance against the side face of a wheel that slides sideways [-];
  /// ishigami_2007 uses 1.
  double side_bulldozing = 1.0;
  /// Stiffness of soil that a wheel loads for the second time over that of the first time [-], in [1, 1000]; its
  /// shear modulus K is divided by the root of this value (rutted()). The default is ours.
  double rut_stiffness = 4.0;
  /// Gravity in which the soil tests were made [m/s^2], in [0, 1e3]; 0: the gravity at the rover's driving
  /// site. underGravity() uses this value.
  double test_gravity_m_s2 = 0.0;
  /// Time after which the strength is correlated by 1/e with that before, for example by its moisture [s], in
  /// [0, 1e12]; 0: the strength does not change with time.
  double correlation_time_s = 0.0;
};

/// Returns the soil for a driving site whose gravity g = gravity_m_s2 is lower than the gravity g_test of the
/// soil tests: c, k_c and k_phi are multiplied by (g / g_test)^exponent, and test_gravity_m_s2 becomes 0. If
/// g >= g_test the soil is returned unchanged. With exponent 1 a rover of the same mass has the same sinkage
/// and the same DP/W (drawbar pull over load) in both gravities. Equal sinkage was measured between 1/6 and 2
/// times Earth's gravity (kobayashi_2010, wong_kobayashi_2012). Scaling the cohesion is conservative (ours),
/// because cohesion does not depend on weight. Friction angle and K are not scaled.
Soil underGravity(Soil soil, double gravity_m_s2, double exponent = 1.0);

/// Returns the sinkage modulus k = k_c/b + k_phi [N/m^(n+2)] for a wheel or plate of smaller dimension b =
/// width_m (thesis Eq. A.1).
double sinkageModulus(const Soil& soil, double width_m);

/// Throws std::invalid_argument that names soil, field, value and bound if a field is outside its range.
void validate(const Soil& soil);

/// Steering system of a rover: skid steering, steered front wheels (Ackermann) or all wheels steered.
enum class Steering { Skid, Ackermann, AllWheel };

/// Rover parameters for route planning. All wheels are equal. Plain data in SI units.
struct Rover {
  std::string name;               ///< name of the rover in reports and errors
  double mass_kg = 0.0;           ///< total mass m, in [0.1, 1e6]
  double gravity_m_s2 = 9.80665;  ///< gravity g at the driving site, in [1e-4, 1e3]
  int wheel_count = 4;            ///< number of wheels, in [2, 100]
  Wheel wheel;                    ///< each wheel; radius and width in [1e-3, 10] m, grouser height <= radius
  double wheelbase_m = 0.0;       ///< distance from first to last axle, in [1e-3, 100]
  double track_m = 0.0;           ///< distance between left and right wheel centres, in [1e-3, 100]
  double clearance_m = 0.0;       ///< height of the belly above ground, in [1e-3, max(wheelbase, track)]
  /// Height above ground, >= 0; 0: unknown, without load transfer and tip-over.
  double centre_of_mass_height_m = 0.0;
  /// Forward offset of the centre of mass from mid wheelbase, +-0.499 wheelbase.
  double centre_of_mass_ahead_m = 0.0;
  double centre_of_mass_left_m = 0.0;  ///< offset to the left from the middle of the track, +-0.499 track
  double max_pitch_rad = 0.35;         ///< limit of the rover's tilt along the heading, (0, pi/2)
  double max_roll_rad = 0.35;          ///< limit of the rover's tilt across the heading, (0, pi/2)
  double max_torque_Nm = 0.0;          ///< largest torque of one wheel, in (0, 1e6]
  double max_speed_mps = 0.05;         ///< largest rim speed of the wheels, in [1e-4, 100]
  double turning_radius_m = 0.0;       ///< smallest turning radius: 0 (turn in place) or in [0.001, 1000]
  double hotel_power_W = 0.0;          ///< electrical power that is independent of driving, in [0, 1e6]
  Steering steering = Steering::Skid;

  bool operator==(const Rover&) const = default;
};

/// Energy and time of a turn per radian of heading change, in addition to those of the path length.
struct TurnEffort {
  double energy_J = 0.0;  ///< energy [J/rad], >= 0, includes hotel power (power independent of driving)
  double time_s = 0.0;    ///< time [s/rad], >= 0
};

/// Efforts of a turn while driving on an arc, of a turn in place, and of a change of direction at a vertex of a
/// polyline: in place if the rover can turn in place, otherwise on an arc.
struct TurnEfforts {
  TurnEffort on_arc, in_place, at_vertex;
};

/// Returns the load m g / wheel_count [N] on one wheel on level ground.
double wheelLoad_N(const Rover& rover);

/// Throws std::invalid_argument that names rover, field, value and bound if a field is outside its range.
void validate(const Rover& rover);

/// Readings of one driven wheel of radius r in steady motion: one row of telemetry. Plain data in SI units.
struct WheelSample {
  double load_N = 0.0;     ///< vertical load W > 0
  double torque_Nm = 0.0;  ///< torque T about the axle, positive when driving
  double sinkage_m = 0.0;  ///< sinkage z, in [0, 2 r)
  double slip = 0.0;       ///< slip i = 1 - v/(r omega), in [-1, 1] [-]
};

/// Sinkage and forces of a rigid wheel on soft soil (wong_reece_1967a, wong_reece_1967b; thesis appendix
/// C.1), including travel at an angle to the wheel plane (ishigami_2007).

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
