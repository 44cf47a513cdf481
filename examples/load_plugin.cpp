// Shows   loading a planner from a shared library, giving it a map and requesting a route.
// Needs   talus::planner; a planner's shared library, as installed in lib/talus/libtalus_planner.so.
// Prints  the plugin's planners, and length, energy, time and number of vertices of the route.
// Next    rover_loop.cpp: replanning while the map changes.

#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include <talus/planner/planner.hpp>

namespace {

// Flat sand, 40 m x 30 m, with a wall of rock that has a gap in the south.
std::shared_ptr<const talus::costmap::CostGrid> groundWithWall() {
  const talus::maps::Grid grid{.width = 80, .height = 60, .resolution_m = 0.5, .south_west = {}};
  talus::costmap::MapLayers layers;
  layers.elevation.elevation_m = talus::maps::Raster<float>(grid, 0.0F);
  layers.keep_out = talus::maps::Raster<std::uint8_t>(grid, 0);
  for (int row = 16; row < grid.height; ++row)
    for (int column = 38; column < 41; ++column) layers.keep_out[{column, row}] = 1;

  talus::terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.62;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.centre_of_mass_height_m = 0.4;
  rover.max_torque_Nm = 40.0;
  const talus::terramech::Soil regolith{.name = "regolith",
                                        .cohesion_Pa = 170.0,
                                        .friction_angle_rad = 0.61,
                                        .sinkage_exponent = 1.0,
                                        .cohesive_modulus = 1400.0,
                                        .frictional_modulus = 820000.0,
                                        .shear_modulus_m = 0.018};
  const auto model = std::make_shared<const talus::costmap::GroundModel>(
      talus::costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = regolith}}, .policy = {}});
  return talus::costmap::TraversabilityMap(std::move(layers), model, {}).published();
}

int run(const char* plugin) {
  const auto planner = talus::planner::loadPlugin(plugin);
  const auto offers = planner->capabilities();
  std::printf("%s %s, planner interface %d:", offers.name.c_str(), offers.version.c_str(),
              offers.interface_version);
  for (const auto& name : offers.planners) std::printf(" %s", name.c_str());
  std::puts("");

  planner->configure({.planner = "field"});
  planner->set_map(groundWithWall());
  talus::PlanRequest request;
  request.start = {5.0, 20.0};
  request.goal = {35.0, 20.0};
  const talus::planner::Route route = planner->plan(request);
  if (route.status != talus::planner::RouteStatus::Found) {
    std::printf("no route: %s\n", route.reason.c_str());
    return 1;
  }
  std::printf("%.1f m, %.0f J, %.0f s, %zu vertices\n", route.length_m, route.energy_J, route.time_s,
              route.vertices.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PLUGIN.so\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
