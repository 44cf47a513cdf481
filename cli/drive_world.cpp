#include <algorithm>
#include <cmath>
#include <random>

#include <cli/drive_world.hpp>
#include <terramech/soil_library.hpp>
#include <terramech/yaml_fields.hpp>

namespace talus::cli {
namespace {

using terramech::Soil;
using terramech::YamlFields;

// A mapping stays in range however far the draw lies out.
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

maps::Point anywhere(const maps::Grid& grid, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double x = share(random), y = share(random);
  return {grid.south_west.x_m + x * grid.width * grid.resolution_m,
          grid.south_west.y_m + y * grid.height * grid.resolution_m};
}

}  // namespace

Truth readTruth(const std::string& path) {
  const YamlFields file = YamlFields::file(path);
  file.only({"classes", "terrain_classes", "soils", "patches", "random"});
  Truth truth;
  if (file.has("classes"))
    for (const auto& [number, prior] : terramech::loadTerrainClasses(path))
      truth.classes[number] = prior.mean;
  for (const YamlFields& patch : file.list("patches")) {
    patch.only({"x_m", "y_m", "radius_m", "soil"});
    truth.patches.push_back({{patch.number("x_m"), patch.number("y_m")},
                             patch.number("radius_m"),
                             terramech::loadSoil(patch.word("soil"))});
  }
  truth.patch_soil = terramech::loadSoil("mars_drift");
  if (!file.has("random")) return truth;
  const YamlFields random = file.fields("random");
  random.only({"spread", "patches", "patch_radius_m", "patch_soil"});
  truth.spread = random.number("spread", 0.0);
  truth.random_patches = random.integer("patches", 0);
  truth.patch_radius_m = random.number("patch_radius_m", truth.patch_radius_m);
  truth.patch_soil = terramech::loadSoil(random.word("patch_soil", "mars_drift"));
  return truth;
}

planner::WorldSoils drawWorld(const Truth& truth, const costmap::TraversabilityMap& map,
                              const WorldDraw& draw) {
  std::mt19937_64 random(draw.seed);
  planner::WorldSoils world;
  for (const costmap::GroundClass& ground : map.model().parts().classes) {
    const auto stated = truth.classes.find(ground.number);
    world.classes.push_back(
        varied(stated == truth.classes.end() ? ground.soil : stated->second, truth.spread, random));
  }
  world.patches = truth.patches;
  std::uniform_real_distribution<double> size(0.5, 1.5);
  for (int i = 0; i < truth.random_patches; ++i) {
    const maps::Point centre = anywhere(map.grid(), random);
    const double radius_m = truth.patch_radius_m * size(random);
    const auto near = [&](const maps::Point& p) {
      return std::hypot(centre.x_m - p.x_m, centre.y_m - p.y_m) < radius_m + 2.0;
    };
    if (!near(draw.keep_start) && !near(draw.keep_goal))
      world.patches.push_back({centre, radius_m, truth.patch_soil});
  }
  return world;
}

}  // namespace talus::cli
