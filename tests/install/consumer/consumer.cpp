#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>

#include <talus/planner/planner.hpp>

namespace {

using namespace talus;

std::shared_ptr<const costmap::CostGrid> flatSand() {
  costmap::MapLayers layers;
  layers.elevation.elevation_m =
      maps::Raster<float>({.width = 40, .height = 30, .resolution_m = 0.5, .south_west = {}}, 0.0F);
  terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.62;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.centre_of_mass_height_m = 0.4;
  rover.max_torque_Nm = 40.0;
  const terramech::Soil sand{.name = "regolith",
                             .cohesion_Pa = 170.0,
                             .friction_angle_rad = 0.61,
                             .sinkage_exponent = 1.0,
                             .cohesive_modulus = 1400.0,
                             .frictional_modulus = 820000.0,
                             .shear_modulus_m = 0.018};
  const auto model = std::make_shared<const costmap::GroundModel>(
      costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = sand}}, .policy = {}});
  return costmap::TraversabilityMap(std::move(layers), model, {}).published();
}

// Closed form: over flat ground the route is the straight line of 15 m.
const PlanRequest kThere{.start = {2.25, 5.25}, .goal = {17.25, 5.25}};
bool isStraight(const Route& route) {
  std::printf("%s: %.3f m %s\n", route.planner.c_str(), route.length_m, route.reason.c_str());
  return std::abs(route.length_m - 15.0) < 1e-3;
}

}  // namespace

// Uses the installed headers and libraries alone: Talus' own planner linked in, and the installed plugin.
int main(int argc, char** argv) try {
  const auto plugin = planner::loadPlugin(argc > 1 ? argv[1] : "");
  plugin->set_map(flatSand());
  return isStraight(Planner().plan(flatSand(), kThere)) && isStraight(plugin->plan(kThere)) ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
