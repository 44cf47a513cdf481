#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/maps/sites/rock_field.hpp>
#include <talus/maps/sites/value_noise.hpp>

namespace talus::maps {
namespace {

constexpr double kPatch_m = 8.0;  // side of a square with constant abundance
constexpr int kSizes = 12;        // number of diameter intervals, in geometric progression

// Random integer with the given mean: floor(mean) or floor(mean) + 1.
int chance(double mean, RandomSequence& random) {
  return static_cast<int>(mean + random());
}

}  // namespace

double Rock::height_m(double distance_m) const {
  const double r = distance_m / radius_m;
  return r < 1 ? radius_m * std::sqrt(1 - r * r) : 0.0;
}

double rockDecay_per_m(double total_share) {
  return 1.79 + 0.152 / total_share;
}

std::vector<Rock> rockField(const Grid& grid, const std::function<double(Point)>& abundance,
                            const RockOptions& options) {
  std::vector<Rock> rocks;
  RandomSequence random(options.seed);
  const double width_m = grid.width * grid.resolution_m;
  const double height_m = grid.height * grid.resolution_m;
  const double step = std::pow(options.greatest_diameter_m / options.least_diameter_m, 1.0 / kSizes);
  for (double y = 0; y < height_m; y += kPatch_m)
    for (double x = 0; x < width_m; x += kPatch_m) {
      const Point corner{grid.south_west.x_m + x, grid.south_west.y_m + y};
      const double k = abundance({corner.x_m + kPatch_m / 2, corner.y_m + kPatch_m / 2});
      if (k <= 0) continue;
      const double q = rockDecay_per_m(k);
      double d = options.least_diameter_m;
      for (int i = 0; i < kSizes; ++i, d *= step) {
        // Area fraction of the rocks in this diameter interval, and the radius of a rock.
        const double share = k * (std::exp(-q * d) - std::exp(-q * d * step));
        const double radius_m = 0.5 * d * std::sqrt(step);
        const int count =
            chance(share * kPatch_m * kPatch_m / (std::numbers::pi * radius_m * radius_m), random);
        for (int n = 0; n < count; ++n)
          rocks.push_back({{corner.x_m + kPatch_m * random(), corner.y_m + kPatch_m * random()}, radius_m});
      }
    }
  return rocks;
}

}  // namespace talus::maps
