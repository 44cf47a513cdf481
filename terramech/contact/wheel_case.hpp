#pragma once

namespace talus::terramech {

/// Parameters of one wheel on one soil at one slip, as a flat record for batches.
struct WheelCase {
  double cohesion_Pa = 0.0;         ///< >= 0
  double friction_angle_rad = 0.0;  ///< [0, pi/2)
  double sinkage_exponent = 1.0;    ///< n > 0 [-]
  double sinkage_modulus = 0.0;     ///< k_c/b + k_phi > 0 [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< K > 0
  double c1 = 0.43;                 ///< [-]
  double c2 = 0.32;                 ///< [-]
  double wheel_radius_m = 0.1;      ///< > 0
  double wheel_width_m = 0.1;       ///< > 0
  double load_N = 0.0;              ///< > 0
  double slip = 0.0;                ///< [-1, 1], see WheelOperation::slip
  /// [-pi/2, pi/2]; at 0 the fields below have no effect, except lugs and slip sinkage
  double slip_angle_rad = 0.0;
  double density_kg_m3 = 1600.0;       ///< > 0
  double gravity_m_s2 = 9.80665;       ///< > 0
  double digging_exponent = 0.4;       ///< [0, 2], see Soil
  double side_bulldozing = 1.0;        ///< >= 0, see Soil
  double grouser_height_m = 0.0;       ///< >= 0, see Wheel
  double lug_thrust = 0.0;             ///< [0, 5], see Wheel
  double slip_sinkage_exponent = 0.0;  ///< [0, 2], see Soil
};

}  // namespace talus::terramech
