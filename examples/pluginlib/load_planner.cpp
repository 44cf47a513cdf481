// Shows   finding the planners that packages describe to pluginlib, and planning with one of them.
// Needs   talus::planner, pluginlib; AMENT_PREFIX_PATH.
// Prints  their names, and the number of vertices and violations of the route.
// Next    ../load_plugin.cpp: the same without pluginlib.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pluginlib/class_loader.hpp>

#include <talus/planner/planner.hpp>

namespace {

// Level sand, 40 m x 30 m.
std::shared_ptr<const talus::costmap::CostGrid> sand() {
  talus::costmap::MapLayers layers;
  layers.elevation.elevation_m =
      talus::maps::Raster<float>({.width = 80, .height = 60, .resolution_m = 0.5}, 0.0F);
  talus::terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.62;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.max_torque_Nm = 40.0;
  talus::terramech::Soil soil;
  soil.name = "regolith";
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  const auto model = std::make_shared<const talus::costmap::GroundModel>(
      talus::costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = soil}}, .policy = {}});
  return talus::costmap::TraversabilityMap(std::move(layers), model, {}).published();
}

int run(const std::string& wanted) {
  // The base class is registered for the package `talus`; any package may provide planners.
  pluginlib::ClassLoader<talus::GlobalPlanner> loader("talus", "talus::GlobalPlanner");
  for (const std::string& name : loader.getDeclaredClasses())
    std::printf("%s: %s\n", name.c_str(), loader.getClassDescription(name).c_str());
  const auto planner = loader.createUniqueInstance(wanted);
  const auto map = sand();
  planner->set_map(map);
  talus::PlanRequest request;
  request.start = {5.0, 10.0};
  request.goal = {35.0, 10.0};
  const talus::planner::Route route = planner->plan(request);
  if (route.status != talus::planner::RouteStatus::Found) {
    std::printf("no route: %s\n", route.reason.c_str());
    return 1;
  }
  // The map checks the route of any planner.
  std::vector<talus::maps::Point> points;
  for (const auto& vertex : route.vertices) points.push_back({vertex.x_m, vertex.y_m});
  const auto against = talus::planner::violations(*map, points);
  std::printf("%s: %zu vertices, %zu violations\n", wanted.c_str(), points.size(), against.size());
  return against.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PACKAGE/CLASS\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::string line = error.what();
    for (char& c : line)
      if (c == '\n') c = ' ';
    std::fprintf(stderr, "%s\n", line.c_str());
    return 2;
  }
}
