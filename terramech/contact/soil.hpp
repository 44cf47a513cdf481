#pragma once

#include <string>

namespace talus::terramech {

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

}  // namespace talus::terramech
