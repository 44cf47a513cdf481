#pragma once

namespace talus::terramech {

/// Readings of one driven wheel in steady motion: one row of telemetry. Plain data, SI.
struct WheelSample {
  double load_N = 0.0;     ///< W > 0
  double torque_Nm = 0.0;  ///< T, positive when driving
  double sinkage_m = 0.0;  ///< z in [0, 2 r)
  double slip = 0.0;       ///< i = 1 - v/(r omega), in [-1, 1] [-]
};

}  // namespace talus::terramech
