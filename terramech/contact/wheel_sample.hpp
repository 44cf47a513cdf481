#pragma once

namespace talus::terramech {

/// Readings of one driven wheel of radius r in steady motion: one row of telemetry. Plain data in SI units.
struct WheelSample {
  double load_N = 0.0;     ///< vertical load W > 0
  double torque_Nm = 0.0;  ///< torque T about the axle, positive when driving
  double sinkage_m = 0.0;  ///< sinkage z, in [0, 2 r)
  double slip = 0.0;       ///< slip i = 1 - v/(r omega), in [-1, 1] [-]
};

}  // namespace talus::terramech
