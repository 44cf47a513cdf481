#include <cmath>

#include <talus/terramech/effects/wheel_contact.hpp>
#include <talus/terramech/mobility/steering_limit.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

double steeringSlipLimit(const Soil& soil, const Wheel& wheel, const SteeringDemand& demand) {
  validate(soil);
  validate(wheel);
  const RangeCheck check{"steering demand"};
  check.above("load_N", demand.load_N, 0.0);
  check.within("slip_angle_rad", demand.slip_angle_rad, {1e-6, 1.57});
  check.atLeast("side_force_over_load", demand.side_force_over_load, 0.0);
  WheelContact contact = contactOf(soil, wheel);
  contact.load_N = demand.load_N;
  contact.slip_angle_rad = demand.slip_angle_rad;
  contact.cohesion_Pa *= shearGain(wheel);
  contact.tan_friction *= shearGain(wheel);
  const auto steers = [&](double slip) {
    contact.slip = slip;
    return std::abs(solveContact(contact).side_force_N) >= demand.side_force_over_load * demand.load_N;
  };
  if (!steers(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (steers(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace talus::terramech
