#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/simulation/worlds/world_draw.hpp>

namespace talus::planner {
namespace {

using terramech::Soil;

constexpr double kClear_m = 2.0;  // distance of start and goal from random patches

// Limits the factor, so that extreme draws leave a soil within its range.
double scaled(double value, double factor) {
  return value * std::max(factor, 0.2);
}

Soil varied(Soil soil, double spread, std::mt19937_64& random) {
  std::normal_distribution<double> factor(1.0, spread);
  soil.cohesion_Pa = scaled(soil.cohesion_Pa, factor(random));
  soil.friction_angle_rad = std::atan(scaled(std::tan(soil.friction_angle_rad), factor(random)));
  const double stiffness = std::max(factor(random), 0.2);
  soil.cohesive_modulus *= stiffness;
  soil.frictional_modulus *= stiffness;
  return soil;
}

// Random generator of one class: depends on the world's seed and the class number, not on other declared
// classes.
std::mt19937_64 drawsOf(std::uint64_t seed, int number) {
  const auto low = [](std::uint64_t word) { return static_cast<std::uint32_t>(word); };
  std::seed_seq words{low(seed), low(seed >> 32), static_cast<std::uint32_t>(number)};
  return std::mt19937_64(words);
}

// The spectrum of exp(-d / l) is that of k = (a, b) / (l |c|) with normal a, b and c.
GroundDepartures departures(const std::vector<costmap::GroundClass>& classes, std::uint64_t seed) {
  constexpr int kWaves = 256;
  constexpr double kCorrelation_m = costmap::TravelPolicy{}.correlation_length_m;
  GroundDepartures made;
  std::normal_distribution<double> normal;
  for (const costmap::GroundClass& ground : classes) {
    std::mt19937_64 own = drawsOf(seed + 1, ground.number);
    made.of_class.push_back(ground.mean_std * normal(own));
    made.place_std.push_back(ground.pull_std);
  }
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  for (int k = 0; k < kWaves; ++k) {
    const double x = normal(random), y = normal(random),
                 per_m = 1.0 / (kCorrelation_m * std::max(std::abs(normal(random)), 1e-3));
    made.waves.push_back({x * per_m, y * per_m, phase(random)});
  }
  return made;
}

maps::Point anywhere(const maps::Grid& grid, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double x = share(random), y = share(random);
  return {grid.south_west.x_m + x * grid.width * grid.resolution_m,
          grid.south_west.y_m + y * grid.height * grid.resolution_m};
}

}  // namespace

WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw) {
  WorldSoils world;
  for (const costmap::GroundClass& ground : classes) {
    const auto stated = truth.classes.find(ground.number);
    std::mt19937_64 own = drawsOf(draw.seed, ground.number);
    world.classes.push_back(
        varied(stated == truth.classes.end() ? ground.soil : stated->second, truth.spread, own));
    double& rut = world.classes.back().rut_stiffness;
    if (truth.as_believed)
      rut = std::max(1.0, rut + ground.rut_stiffness_std * std::normal_distribution<double>()(own));
  }
  if (truth.as_believed) world.departures = departures(classes, draw.seed);
  world.patches = truth.patches;
  world.effects = truth.effects;
  std::mt19937_64 random(draw.seed);
  const Soil patch_soil = truth.random_patches > 0 ? varied(truth.patch_soil, truth.spread, random) : Soil{};
  std::uniform_real_distribution<double> size(0.5, 1.5);
  for (int i = 0; i < truth.random_patches; ++i) {
    const maps::Point centre = anywhere(grid, random);
    const double radius_m = truth.patch_radius_m * size(random);
    const auto near = [&](const maps::Point& p) {
      return std::hypot(centre.x_m - p.x_m, centre.y_m - p.y_m) < radius_m + kClear_m;
    };
    if (!near(draw.start) && !near(draw.goal)) world.patches.push_back({centre, radius_m, patch_soil});
  }
  return world;
}

}  // namespace talus::planner
