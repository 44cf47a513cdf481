#include <cmath>

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

double shearGain(const Wheel& wheel) noexcept {
  const double h = wheel.grouser_height_m, b = wheel.width_m;
  return h > 0.0 && wheel.lug_thrust > 0.0 ? 1.0 + wheel.lug_thrust * 0.64 * h / b * std::atan(b / h) : 1.0;
}

void validate(const Wheel& wheel) {
  const RangeCheck check{"wheel"};
  check.above("radius_m", wheel.radius_m, 0.0);
  check.above("width_m", wheel.width_m, 0.0);
  check.within("radius_m", wheel.radius_m, {1e-4, 10.0});
  check.within("width_m", wheel.width_m, {1e-4, 10.0});
  check.within("grouser_height_m", wheel.grouser_height_m, {0.0, 1.0});
  check.within("grouser_count", wheel.grouser_count, {0.0, 1000.0});
  check.within("lug_thrust", wheel.lug_thrust, {0.0, 5.0});
}

}  // namespace talus::terramech
