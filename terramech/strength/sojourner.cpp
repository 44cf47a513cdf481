#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/numerics/range.hpp>
#include <talus/terramech/strength/sojourner.hpp>

namespace talus::terramech {

StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample) {
  RangeCheck("wheel spin").above("sinkage_m", sample.sinkage_m, 0.0);
  const double area = wheel.width_m * contactChord_m(wheel, sample.sinkage_m);
  return {.normal_Pa = sample.load_N / area, .shear_Pa = sample.torque_Nm / (wheel.radius_m * area)};
}

}  // namespace talus::terramech
