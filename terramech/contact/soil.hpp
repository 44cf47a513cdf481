#pragma once

#include <string>

namespace talus::terramech {

/// Homogeneous soil with Bekker's pressure-sinkage and Janosi and Hanamoto's shear stress. Plain data, SI.
struct Soil {
  std::string name;                 ///< name in reports and errors
  double cohesion_Pa = 0.0;         ///< c in [0, 1e9]
  double friction_angle_rad = 0.0;  ///< phi in [0, pi/2)
  double sinkage_exponent = 1.0;    ///< n in [1e-3, 100] [-]
  double cohesive_modulus = 0.0;    ///< k_c [N/m^(n+1)]; may be negative as long as k_c/b + k_phi > 0
  double frictional_modulus = 0.0;  ///< k_phi [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K in [1e-9, 1000]
  double c1 = 0.43;                 ///< theta_m / theta_1 at slip 0 [-], finite (wong_reece_1967a)
  double c2 = 0.32;                 ///< increase of theta_m / theta_1 per unit slip [-], finite
  double density_kg_m3 = 1600.0;    ///< bulk density of the soil pushed aside, in [0.1, 1e6]
  /// Slip-sinkage exponent n1 in [0, 2] [-]: n = n0 + n1 |i| (ding_2010: 0.2 to 0.6, number unverified). 0:
  /// no slip sinkage, as in the thesis.
  double slip_sinkage_exponent = 0.0;
  /// Digging exponent n_d in [0, 2] [-] of a wheel that slides sideways: n = n0 + n_d (s_R - |i|), s_R =
  /// resultantSlip(). Form and magnitude are those of ding_2010's slip-sinkage exponent (0.2 to 0.6, number
  /// unverified); the use of the resultant slip is ours.
  double digging_exponent = 0.4;
  /// Factor >= 0 on Hegedus' pressure on the side face of a wheel that slides sideways [-]; 1 as in
  /// ishigami_2007.
  double side_bulldozing = 1.0;
  /// Gravity of the soil tests [m/s^2], in [0, 1e3]; 0: the gravity where the rover drives. See
  /// underGravity().
  double test_gravity_m_s2 = 0.0;
};

/// Returns the soil for a lower gravity than that of its tests: c, k_c and k_phi times (g / g_test)^exponent,
/// and test_gravity_m_s2 = 0. If g >= g_test the soil is returned unchanged. With exponent 1 a rover of the
/// same mass has the same sinkage and the same DP/W (drawbar pull over load) in both gravities. Equal sinkage
/// was measured between 1/6 and 2 times Earth's gravity (kobayashi_2010, wong_kobayashi_2012). Scaling the
/// cohesion is conservative (ours), because cohesion does not depend on weight. Friction angle and K are not
/// scaled.
Soil underGravity(Soil soil, double gravity_m_s2, double exponent = 1.0);

/// Returns k = k_c/b + k_phi [N/m^(n+2)] for a wheel or plate of smaller dimension b = width_m [m] (thesis
/// Eq. A.1).
double sinkageModulus(const Soil& soil, double width_m);

/// Throws std::invalid_argument with soil, field, value and bound if a field is outside its range.
void validate(const Soil& soil);

}  // namespace talus::terramech
