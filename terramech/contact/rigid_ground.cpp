#include <cmath>

#include <talus/terramech/contact/rigid_ground.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

RigidGroundForces rigidGroundForces(const Wheel& wheel, const GroundFriction& friction, double load_N,
                                    double torque_Nm) {
  validate(wheel);
  const RangeCheck check{"wheel on rigid ground"};
  check.above("load_N", load_N, 0.0);
  check.finite("torque_Nm", torque_Nm);
  check.atLeast("kinetic_coefficient", friction.kinetic_coefficient, 0.0);
  check.atLeast("static_coefficient", friction.static_coefficient, friction.kinetic_coefficient);
  const double thrust_N = torque_Nm / wheel.radius_m;
  if (std::abs(thrust_N) <= friction.static_coefficient * load_N) return {thrust_N, false};
  return {std::copysign(friction.kinetic_coefficient * load_N, torque_Nm), true};
}

}  // namespace talus::terramech
