#pragma once

namespace talus::terramech {

/// Parameters of one wheel on one soil at one load and slip, as a flat record for batch computations. Each
/// field has the meaning of the field of the same name in Soil, Wheel or WheelOperation.
struct WheelCase {
  double cohesion_Pa = 0.0;         ///< cohesion c >= 0
  double friction_angle_rad = 0.0;  ///< friction angle phi, [0, pi/2)
  double sinkage_exponent = 1.0;    ///< sinkage exponent n > 0 [-]
  double sinkage_modulus = 0.0;     ///< sinkage modulus k = k_c/b + k_phi > 0 [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K > 0
  double c1 = 0.43;                 ///< theta_m / theta_1 (stress-peak angle over entry angle) at slip 0 [-]
  double c2 = 0.32;                 ///< increase of theta_m / theta_1 per unit slip [-]
  double wheel_radius_m = 0.1;      ///< r > 0
  double wheel_width_m = 0.1;       ///< b > 0
  double load_N = 0.0;              ///< vertical load W > 0
  double slip = 0.0;  ///< driven (>= 0) or braked (< 0) slip in [-1, 1], defined in WheelOperation::slip
  /// Slip angle beta, [-pi/2, pi/2]. At 0 the fields below have no effect, except those of lugs and of slip
  /// sinkage.
  double slip_angle_rad = 0.0;
  double density_kg_m3 = 1600.0;       ///< bulk density of the soil > 0
  double gravity_m_s2 = 9.80665;       ///< > 0
  double digging_exponent = 0.4;       ///< [0, 2], defined in Soil
  double side_bulldozing = 1.0;        ///< >= 0, defined in Soil
  double grouser_height_m = 0.0;       ///< >= 0, defined in Wheel
  double lug_thrust = 0.0;             ///< [0, 5], defined in Wheel
  double slip_sinkage_exponent = 0.0;  ///< [0, 2], defined in Soil
};

}  // namespace talus::terramech
