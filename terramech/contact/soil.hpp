#pragma once

#include <string>

namespace talus::terramech {

/// A homogeneous soil under Bekker pressure-sinkage and Janosi-Hanamoto shear. Plain data, SI.
struct Soil {
  std::string name;                 ///< for reports
  double cohesion_Pa = 0.0;         ///< c in [0, 1e9]
  double friction_angle_rad = 0.0;  ///< phi in [0, pi/2)
  double sinkage_exponent = 1.0;    ///< n in [1e-3, 100] [-]
  double cohesive_modulus = 0.0;    ///< k_c [N/m^(n+1)]; may be negative as long as k_c/b + k_phi > 0
  double frictional_modulus = 0.0;  ///< k_phi [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K in [1e-9, 1000]
  double c1 = 0.43;                 ///< theta_m / theta_1 at no slip [-] (Wong and Reece; wong_reece_1967a)
  double c2 = 0.32;                 ///< its growth with slip [-]
  double density_kg_m3 = 1600.0;    ///< bulk density in [0.1, 1e6], of soil that is moved
  /// n1 in [0, 2] [-]: slip sinkage, n = n0 + n1 |i| (ding_2010: 0.2 to 0.6, number unverified); 0: none, as the thesis.
  double slip_sinkage_exponent = 0.0;
  /// n_d >= 0 [-] of a wheel that slides sideways: n = n0 + n_d (s_R - |i|), s_R = resultantSlip(). The form
  /// and size of ding_2010's growth with slip (n1 0.2 to 0.6, number unverified), taken over the resultant:
  /// ours.
  double digging_exponent = 0.4;
  /// Share >= 0 of Hegedus' pressure on the side of a wheel that slides sideways, 1 as ishigami_2007 [-].
  double side_bulldozing = 1.0;
  /// Gravity in which the soil was tested, >= 0; 0: that of the body driven on. See underGravity().
  double test_gravity_m_s2 = 0.0;
};

/// The soil as it is where a wheel weighs less than where it was tested: c, k_c and k_phi times (g / g_test)^exponent. With exponent 1 a rover
/// of the same mass sinks as deep and pulls as large a part of its weight as there: that of sinkage was measured in 1/6 to 2 times
/// the Earth's gravity (kobayashi_2010, wong_kobayashi_2012), that of the cohesion, which does not weigh, errs towards danger (ours).
/// Never stronger than tested; friction angle and K stay.
Soil underGravity(Soil soil, double gravity_m_s2, double exponent = 1.0);

/// k = k_c/b + k_phi [N/m^(n+2)] for a wheel or plate of smaller dimension width_m (thesis Eq. A.1).
double sinkageModulus(const Soil& soil, double width_m);

/// Throws std::invalid_argument naming soil, field, value and bound when a field leaves its range.
void validate(const Soil& soil);

}  // namespace talus::terramech
