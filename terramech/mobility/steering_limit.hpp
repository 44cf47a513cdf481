#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Side force that steering requires of a wheel.
struct SteeringDemand {
  double load_N = 0.0;             ///< vertical load on the wheel, > 0
  double slip_angle_rad = 0.2618;  ///< largest slip angle that steering may cause, (0, pi/2); default 15 deg
  /// Required side force divided by the load, for a turn or a side slope, >= 0 [-].
  double side_force_over_load = 0.1;
};

/// Returns the slip in [0, 1] above which the side force of a wheel at the slip angle of `demand` is below
/// the required side force. A spinning wheel shears the soil backwards, and the strength that remains across
/// the wheel plane falls to 0 at slip 1, because the shear stress acts along the resultant displacement
/// (ishigami_2007). Returns 0 if the side force is too small even at slip 0. The result is a value for
/// CategoryThresholds::steering_slip; the method is not in the thesis. Throws std::invalid_argument if a
/// field is outside its range.
double steeringSlipLimit(const Soil& soil, const Wheel& wheel, const SteeringDemand& demand);

}  // namespace talus::terramech
