#include "example_scene.hpp"

#include <cmath>
#include <cstdlib>

#include <talus/cli/app/output_file.hpp>

namespace talus::cli {
namespace {

double height_m(double x_m, double y_m) {
  return 1200.0 + 30.0 * std::sin(x_m / 60.0) + 20.0 * std::cos(y_m / 45.0);
}

}  // namespace

maps::ElevationMap exampleMap() {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({120, 80, 5.0, {1000.0, 2000.0}});
  map.source = "hills";
  for (int row = 0; row < 80; ++row) {
    for (int column = 0; column < 120; ++column) {
      const maps::Point p = map.grid().centre({column, row});
      const bool hole = std::hypot(column - 90, row - 60) < 8.0;
      map.elevation_m[{column, row}] = hole ? std::nanf("") : static_cast<float>(height_m(p.x_m, p.y_m));
    }
  }
  return map;
}

planner::Route exampleRoute() {
  planner::Route route;
  route.status = planner::RouteStatus::Found;
  for (int i = 0; i <= 60; ++i) {
    planner::RouteVertex v;
    v.x_m = 1050.0 + 8.0 * i;
    v.y_m = 2100.0 + 3.0 * i;
    v.elevation_m = height_m(v.x_m, v.y_m);
    v.heading_rad = std::atan2(3.0, 8.0);
    v.slope_along_rad = 0.2 * std::sin(i / 5.0);
    v.slope_across_rad = -0.05;
    v.slip = 0.1 + 0.3 * std::abs(std::sin(i / 5.0));
    v.sinkage_m = 0.01;
    v.torque_Nm = 2.5;
    v.drawbar_pull_margin = 0.3 - 0.2 * std::sin(i / 5.0);
    v.category = i < 40 ? terramech::Category::Safe : terramech::Category::Marginal;
    v.energy_J = 900.0 * i;
    v.time_s = 170.0 * i;
    v.immobilisation_risk = 0.0002 * i;
    route.vertices.push_back(v);
  }
  const double length_m = 60.0 * std::hypot(8.0, 3.0);
  static_cast<planner::RouteSummary&>(route) = {.cost = 60000.0,
                                                .energy_J = 54000.0,
                                                .time_s = 10200.0,
                                                .length_m = length_m,
                                                .max_slip = 0.4,
                                                .max_slope_rad = 0.2,
                                                .lower_bound = 59000.0,
                                                .gap = 60000.0 / 59000.0 - 1.0,
                                                .planner = "field"};
  return route;
}

Scene exampleScene() {
  Scene scene = sceneOf(exampleMap(), {.title = "Example <hills> & route"});
  scene.headings = maps::Raster<HeadingShares>(scene.grid());
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 120; ++column) {
      const bool known = !std::isnan(scene.elevation_m[{column, row}]);
      const auto category = known ? static_cast<std::size_t>((column / 20 + row / 20) % 3) : std::size_t{3};
      scene.headings[{column, row}].count[category] = 1;
    }
  addRoute(scene, exampleRoute());
  return scene;
}

void keep(const std::string& name, const std::string& bytes) {
  if (const char* folder = std::getenv("TALUS_TEST_PICTURES"))
    writeFile(std::string(folder) + "/" + name, bytes);
}

}  // namespace talus::cli
