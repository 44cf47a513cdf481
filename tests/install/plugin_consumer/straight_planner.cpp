// A planner of somebody else: straight from start to goal, whatever lies between, so that the program's check decides;
// and, by the name it is configured for, every way in which a plugin can go wrong.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include <talus/planner/plugin/plugin_export.hpp>

namespace straight {

class Planner final : public talus::GlobalPlanner {
 public:
  talus::PlannerCapabilities capabilities() const override {
    return {.name = "straight",
            .version = "1",
            .planners = {"line", "throws", "undefined", "crashes", "huge", "endless", "empty", "elsewhere",
                         "odd", "winding", "liar"},
            .planner = settings_.planner.empty() ? "line" : settings_.planner,
            .headings = settings_.planner == "liar",
            .turning_radius = settings_.planner == "liar"};
  }
  void configure(const talus::PlannerSettings& settings) override { settings_ = settings; }
  void set_map(std::shared_ptr<const talus::costmap::CostGrid> map) override { map_ = std::move(map); }
  void update(std::shared_ptr<const talus::costmap::CostGrid> newer) override { set_map(std::move(newer)); }
  talus::planner::Route plan(const talus::PlanRequest& request) override {
    const std::string& how = settings_.planner;
    talus::planner::Route route;
    route.status = talus::planner::RouteStatus::Found;
    add(route, request.start);
    add(route, request.goal);
    if (how == "throws") throw std::runtime_error("no idea\nat all");
    if (how == "odd") throw 7;
    if (how == "undefined") route.vertices[1].x_m = std::nan("");
    if (how == "crashes") std::abort();
    if (how == "huge") route.vertices.resize(100'000'000);
    if (how == "empty") route.vertices.clear();
    if (how == "elsewhere") route.vertices[1].x_m += 1.0;
    for (int turn = 0; how == "winding" && turn < 60'000; ++turn) {  // to and fro, where it may
      const auto last = route.vertices.back();
      route.vertices.push_back(route.vertices[route.vertices.size() - 2]);
      route.vertices.push_back(last);
      if (route.vertices.size() > 90'000) break;
    }
    for (volatile bool on = how == "endless"; on;) {
    }
    return route;
  }
  std::unique_ptr<talus::GlobalPlanner> create() const override { return std::make_unique<Planner>(); }

 private:
  static void add(talus::planner::Route& route, talus::maps::Point at) {
    route.vertices.emplace_back();
    route.vertices.back().x_m = at.x_m;
    route.vertices.back().y_m = at.y_m;
  }

  talus::PlannerSettings settings_;
  std::shared_ptr<const talus::costmap::CostGrid> map_;
};

}  // namespace straight

TALUS_EXPORT_PLANNER(straight::Planner)
