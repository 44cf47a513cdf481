#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

void validate(const Wheel& wheel) {
  const RangeCheck check{"wheel"};
  check.above("radius_m", wheel.radius_m, 0.0);
  check.above("width_m", wheel.width_m, 0.0);
  check.atLeast("grouser_height_m", wheel.grouser_height_m, 0.0);
  check.atLeast("grouser_count", wheel.grouser_count, 0.0);
}

}  // namespace talus::terramech
