#include <cmath>

#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

void check(const Wheel& wheel, double sinkage) {
  const RangeCheck range("wheel contact");
  range.above("radius_m", wheel.radius_m, 0.0);
  range.within("sinkage_m", sinkage, {0.0, std::nextafter(2.0 * wheel.radius_m, 0.0)});
}

}  // namespace

double entryAngle_rad(const Wheel& wheel, double sinkage_m) {
  check(wheel, sinkage_m);
  return 2.0 * std::asin(std::sqrt(sinkage_m / (2.0 * wheel.radius_m)));
}

double sinkage_m(const Wheel& wheel, double entry_angle_rad) {
  const double s = std::sin(0.5 * entry_angle_rad);
  return 2.0 * wheel.radius_m * s * s;
}

double contactChord_m(const Wheel& wheel, double sinkage_m) {
  check(wheel, sinkage_m);
  return 2.0 * std::sqrt(sinkage_m * (2.0 * wheel.radius_m - sinkage_m));
}

}  // namespace talus::terramech
