// A planner of another package, which knows of Talus its interface alone: straight from start to goal.
#include <memory>
#include <utility>

#include <pluginlib/class_list_macros.hpp>

#include <talus/planner/plugin/plugin_export.hpp>

namespace foreign {

class Straight final : public talus::GlobalPlanner {
 public:
  talus::PlannerCapabilities capabilities() const override {
    return {.name = "straight", .version = "1", .planners = {"line"}, .planner = "line"};
  }
  void configure(const talus::PlannerSettings&) override {}
  void set_map(std::shared_ptr<const talus::costmap::CostGrid>) override {}
  void update(std::shared_ptr<const talus::costmap::CostGrid>) override {}
  talus::planner::Route plan(const talus::PlanRequest& request) override {
    talus::planner::Route route;
    route.status = talus::planner::RouteStatus::Found;
    for (const talus::maps::Point at : {request.start, request.goal}) {
      route.vertices.emplace_back();
      route.vertices.back().x_m = at.x_m;
      route.vertices.back().y_m = at.y_m;
    }
    return route;
  }
  std::unique_ptr<talus::GlobalPlanner> create() const override { return std::make_unique<Straight>(); }
};

}  // namespace foreign

PLUGINLIB_EXPORT_CLASS(foreign::Straight, talus::GlobalPlanner)
