#include <cmath>
#include <numbers>

#include <talus/costmap/surface/rock_hazard.hpp>

namespace talus::costmap {
namespace {

constexpr double kMostCounted = 0.5;

}  // namespace

double rockHazard(double abundance, const RockCrossing& crossing) {
  if (!(abundance > 0.0)) return 0.0;
  if (abundance > kMostCounted) return 1.0;
  const double q = 1.79 + 0.152 / abundance;
  const double x = q * crossing.diameter_m;
  const double exponential_integral = -std::expint(-x);  // E1(x)
  const double rocks_per_m2 = 4.0 * abundance * q / std::numbers::pi *
                              (std::exp(-x) / crossing.diameter_m - q * exponential_integral);
  return -std::expm1(-rocks_per_m2 * crossing.area_m2);
}

}  // namespace talus::costmap
