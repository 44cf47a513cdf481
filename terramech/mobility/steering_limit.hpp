#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Lateral force that steering requires of a wheel.
struct SteeringDemand {
  double load_N = 0.0;             ///< on the wheel, > 0
  double slip_angle_rad = 0.2618;  ///< largest slip angle, (0, pi/2); 15 deg
  /// Required side force for a turn or a side slope, over the load, >= 0 [-].
  double side_force_over_load = 0.1;
};

/// Returns the slip in [0, 1] above which the side force at the slip angle is below the demand. A spinning
/// wheel shears the soil backwards, and the strength left across the travel falls to 0 at slip 1 (shear along
/// the resultant displacement; ishigami_2007). Returns 0 if even a rolling wheel cannot meet the demand. Sets
/// CategoryThresholds::steering_slip; not in the thesis. Throws std::invalid_argument if a field is outside
/// its range.
double steeringSlipLimit(const Soil& soil, const Wheel& wheel, const SteeringDemand& demand);

}  // namespace talus::terramech
