// Shows   the planner in a rover's loop: observe the ground, plan, drive a little, process wheel telemetry.
// Needs   talus::planner.
// Prints  one line per step: position, remaining cost, and DP/W of the ground with its standard deviation.
// Next    plan_site.cpp: the same types on a site of files.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <talus/planner/planner.hpp>

namespace {

using talus::maps::Cell;
using talus::maps::Point;

const talus::maps::Grid kGrid{.width = 120, .height = 80, .resolution_m = 0.5, .south_west = {}};

// Simulated ground: a hill, a strip of soft ground, and a wall of rocks with a gap in the north.
float height(Point p) {
  return static_cast<float>(1.5 * std::exp(-0.01 * (std::pow(p.x_m - 20, 2) + std::pow(p.y_m - 6, 2))));
}
bool soft(Point p) {
  return p.x_m > 14 && p.x_m < 18;
}
bool rocky(Point p) {
  return p.x_m > 29 && p.x_m < 31 && p.y_m < 32;
}

talus::terramech::Rover rover() {
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
  return rover;
}

// Returns a map without observations: unknown ground is planned as level ground of its single soil class.
talus::Map unseen() {
  talus::terramech::Soil soil;
  soil.name = "regolith";
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  talus::Site site{.layers = {},
                   .ground = talus::costmap::GroundModel(
                       {.rover = rover(), .classes = {{.soil = soil}}, .policy = {.allow_unknown = true}})};
  site.layers.elevation.elevation_m =
      talus::maps::Raster<float>(kGrid, std::numeric_limits<float>::quiet_NaN());
  return talus::Map(std::move(site));
}

// Simulated perception within 12 m of the rover, as a window of the map's cells; NaN: not observed.
talus::costmap::SurfacePatch look(Point from) {
  const Cell here = *kGrid.cellAt(from);
  const Cell first{std::max(here.column - 24, 0), std::max(here.row - 24, 0)};
  talus::maps::Grid window = kGrid;
  window.width = std::min(here.column + 24, kGrid.width - 1) - first.column + 1;
  window.height = std::min(here.row + 24, kGrid.height - 1) - first.row + 1;
  window.south_west = {first.column * kGrid.resolution_m, first.row * kGrid.resolution_m};
  talus::costmap::SurfacePatch seen;
  seen.elevation_m = talus::maps::Raster<float>(window, std::numeric_limits<float>::quiet_NaN());
  seen.rock_abundance = seen.elevation_m;
  for (int row = 0; row < window.height; ++row)
    for (int column = 0; column < window.width; ++column) {
      const Point p = window.centre({column, row});
      if (std::hypot(p.x_m - from.x_m, p.y_m - from.y_m) > 12.0) continue;
      seen.elevation_m[{column, row}] = height(p);
      seen.rock_abundance[{column, row}] = rocky(p) ? 0.9F : 0.0F;
    }
  return seen;
}

// Simulated readings of four wheels at one time: higher slip and sinkage on soft ground. Columns as in a
// telemetry file.
talus::terramech::Telemetry wheels(Point at, double heading_rad, double time_s) {
  talus::terramech::Telemetry t;
  t.source = "wheels";
  t.words = {{"wheel", {}}};
  for (const char* name :
       {"time_s", "x_m", "y_m", "load_N", "slip", "sinkage_m", "heading_rad", "pose_std_m"})
    t.numbers.push_back({name, {}});
  const talus::terramech::Rover r = rover();
  for (const double along : {-0.5, 0.5})
    for (const double across : {-0.5, 0.5}) {
      const double x = along * r.wheelbase_m, y = across * r.track_m;
      const Point p{at.x_m + x * std::cos(heading_rad) - y * std::sin(heading_rad),
                    at.y_m + x * std::sin(heading_rad) + y * std::cos(heading_rad)};
      const double row[] = {time_s,
                            p.x_m,
                            p.y_m,
                            0.25 * r.mass_kg * r.gravity_m_s2,
                            soft(p) ? 0.2 : 0.04,
                            soft(p) ? 0.04 : 0.01,
                            heading_rad,
                            0.1};
      for (std::size_t k = 0; k < t.numbers.size(); ++k) t.numbers[k].values.push_back(row[k]);
      t.words[0].values.push_back(std::to_string(t.lines.size()));
      t.lines.push_back(t.lines.size() + 1);
    }
  return t;
}

// Place and heading at a distance along the route.
struct Reached {
  Point place;
  double heading_rad;
};
Reached along(const std::vector<talus::RouteVertex>& route, double metres) {
  double heading_rad = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double dx = route[i].x_m - route[i - 1].x_m, dy = route[i].y_m - route[i - 1].y_m;
    const double leg = std::hypot(dx, dy);
    heading_rad = std::atan2(dy, dx);
    if (metres < leg)
      return {{route[i - 1].x_m + metres / leg * dx, route[i - 1].y_m + metres / leg * dy}, heading_rad};
    metres -= leg;
  }
  return {{route.back().x_m, route.back().y_m}, heading_rad};
}

}  // namespace

int main() {
  talus::Map map = unseen();
  talus::Planner planner({.planner = "field", .time_limit_s = 5.0});
  std::stop_source stop;  // another thread may request a stop at any time
  talus::PlanRequest request;
  request.start = {5.0, 10.0};
  request.goal = {55.0, 10.0};
  request.watch.stop = stop.get_token();
  for (int step = 0; step < 100 && !(request.start == request.goal); ++step) {
    map.patch(look(request.start));
    const talus::Route route = planner.plan(map, request);
    if (!route.found()) {
      std::printf("stopped: %s\n", route.reason.c_str());
      return 1;
    }
    const auto ground = map.ground().ground(*kGrid.cellAt(request.start));
    std::printf("step %2d at (%4.1f, %4.1f) m, cost to go %6.0f J, DP/W here %.2f +- %.2f\n", step,
                request.start.x_m, request.start.y_m, route.cost, ground->pull.value, ground->pull.std);
    const Reached next = along(route.vertices, 3.0);
    map.learnPart(wheels(next.place, next.heading_rad, 30.0 * (step + 1)));
    request.start = next.place;
  }
  return request.start == request.goal ? 0 : 1;
}
