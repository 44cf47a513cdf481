// Shows   the planner inside a rover's loop: plan, drive a little, see more ground, take the new map in, plan
// again. Needs   talus::planner. Prints  a line a step: where the rover is, what is left to go, and why it
// turned. Next    load_plugin.cpp: the same planner from a shared library.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stop_token>
#include <vector>

#include <talus/planner/planner.hpp>

namespace {

using talus::maps::Point;

const talus::maps::Grid kGrid{.width = 120, .height = 80, .resolution_m = 0.5, .south_west = {}};

// The world: a wall of rocks across the way, open in the north. The rover sees 12 m far.
bool rocky(Point p) {
  return p.x_m > 29 && p.x_m < 31 && p.y_m < 32;
}

std::shared_ptr<const talus::costmap::GroundModel> ground() {
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
  talus::terramech::Soil soil;
  soil.name = "regolith";
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  talus::costmap::GroundClass regolith;
  regolith.soil = soil;
  return std::make_shared<const talus::costmap::GroundModel>(
      talus::costmap::GroundModel::Parts{.rover = rover, .classes = {regolith}, .policy = {}});
}

// What the rover knows of the world so far, as a map to plan on.
class Knowledge {
 public:
  bool look(Point from) {
    bool news = false;
    for (int row = 0; row < kGrid.height; ++row)
      for (int column = 0; column < kGrid.width; ++column) {
        const Point p = kGrid.centre({column, row});
        if (std::hypot(p.x_m - from.x_m, p.y_m - from.y_m) > 12.0 || !rocky(p) || rocks_[{column, row}])
          continue;
        rocks_[{column, row}] = 1;
        news = true;
      }
    return news;
  }

  std::shared_ptr<const talus::costmap::CostGrid> map() const {
    talus::costmap::MapLayers layers;
    layers.elevation.elevation_m = talus::maps::Raster<float>(kGrid, 0.0F);
    layers.keep_out = rocks_;
    return talus::costmap::TraversabilityMap(std::move(layers), model_, {}).published();
  }

 private:
  std::shared_ptr<const talus::costmap::GroundModel> model_ = ground();
  talus::maps::Raster<std::uint8_t> rocks_{kGrid, 0};
};

// The place some metres along the route.
Point along(const std::vector<talus::planner::RouteVertex>& route, double metres) {
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double dx = route[i].x_m - route[i - 1].x_m, dy = route[i].y_m - route[i - 1].y_m;
    const double leg = std::hypot(dx, dy);
    if (metres < leg) return {route[i - 1].x_m + metres / leg * dx, route[i - 1].y_m + metres / leg * dy};
    metres -= leg;
  }
  return {route.back().x_m, route.back().y_m};
}

}  // namespace

int main() {
  Knowledge knowledge;
  const auto planner = talus::planner::makePlanner("field");
  planner->configure({.planner = "field", .time_limit_s = 5.0});
  planner->set_map(knowledge.map());
  std::stop_source stop;  // another thread may ask to stop at any time
  talus::PlanRequest request;
  request.start = {5.0, 10.0};
  request.goal = {55.0, 10.0};
  request.watch.stop = stop.get_token();
  for (int step = 0; step < 100 && !(request.start == request.goal); ++step) {
    const bool news = knowledge.look(request.start);
    if (news) planner->update(knowledge.map());
    const talus::planner::Route route = planner->plan(request);
    if (route.status != talus::planner::RouteStatus::Found) {
      std::printf("stopped: %s\n", route.reason.c_str());
      return 1;
    }
    std::printf("step %2d at (%4.1f, %4.1f) m, cost to go %6.0f J%s\n", step, request.start.x_m,
                request.start.y_m, route.summary.cost, news ? ", rocks seen, planned anew" : "");
    request.start = along(route.vertices, 3.0);
  }
  return request.start == request.goal ? 0 : 1;
}
