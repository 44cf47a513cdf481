#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// The lateral force that steering requires of a wheel.
struct SteeringDemand {
  double load_N = 0.0;             ///< on the wheel, > 0
  double slip_angle_rad = 0.2618;  ///< largest angle between wheel and travel, (0, pi/2); 15 deg
  /// Force across the wheel that turning or a side slope asks for, over the load [-].
  double side_force_over_load = 0.1;
};

/// The slip in [0, 1] above which the wheel cannot give the side force at the slip angle: a spinning wheel
/// drags the soil backwards, and what is left of its strength across the travel fades to nothing at slip 1
/// (shear along the resultant displacement; ishigami_2007). 0 where even a rolling wheel cannot give it. The
/// thesis leaves this limit out; it sets CategoryThresholds::steering_slip. Throws std::invalid_argument when
/// a field leaves its range.
double steeringSlipLimit(const Soil& soil, const Wheel& wheel, const SteeringDemand& demand);

}  // namespace talus::terramech
