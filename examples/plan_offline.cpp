// Shows   planning with an elevation file, and a rover and a soil from the library.
// Needs   talus::planner, talus::maps_io (GDAL), talus::terramech_io (YAML); an elevation file such as hill.asc.
// Prints  length, energy, time, steepest slope and largest slip, there and back: on a slope they differ.
// Next    `talus plan --help` does the same and more from the command line.

#include <cstdio>
#include <exception>
#include <memory>
#include <utility>

#include <talus/maps/maps_io.hpp>
#include <talus/planner/planner.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace {

using talus::planner::Route;

void print(const char* title, const Route& route) {
  std::printf("%s: %.1f m, %.0f J, %.0f s, steepest %.1f deg, largest slip %.2f\n", title,
              route.summary.length_m, route.summary.energy_J, route.summary.time_s,
              route.summary.max_slope_rad / talus::kDegree, route.summary.max_slip);
}

int run(const char* file) {
  talus::costmap::MapLayers layers;
  talus::maps::ReadOptions options;
  options.resolution_m = 1.0;  // the file has no coordinate system
  layers.elevation = talus::maps::readElevation(file, options);
  talus::costmap::GroundModel::Parts ground;
  ground.rover = talus::terramech::loadRover("mer");
  ground.classes = {{.soil = talus::terramech::loadSoil("sand")}};
  std::printf("%s on %s\n", ground.rover.name.c_str(), ground.classes.front().soil.name.c_str());
  const talus::costmap::TraversabilityMap map(
      std::move(layers), std::make_shared<const talus::costmap::GroundModel>(std::move(ground)), {});

  talus::PlanRequest request;
  request.start = map.grid().centre({4, 10});
  request.goal = map.grid().centre({35, 22});
  const Route there = talus::planner::planRoute(map.published(), request);
  std::swap(request.start, request.goal);
  const Route back = talus::planner::planRoute(map.published(), request);
  if (there.status != talus::planner::RouteStatus::Found ||
      back.status != talus::planner::RouteStatus::Found) {
    std::printf("no route: %s%s\n", there.reason.c_str(), back.reason.c_str());
    return 1;
  }
  print("there", there);
  print("back ", back);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s ELEVATION_FILE\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
