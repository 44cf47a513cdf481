#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plugin/named_planner.hpp>
#include <talus/planner/plugin/plugin_export.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {
namespace {

// Talus' own planners behind the plugin interface.
class Plugin final : public GlobalPlanner {
 public:
  PlannerCapabilities capabilities() const override {
    return {.interface_version = kPlannerInterfaceVersion,
            .name = "talus",
            .version = TALUS_VERSION,
            .planners = plannerNames(),
            .heading_dependent = true,
            .lower_bound = true,
            .via_points = true,
            .several_goals = true,
            .incremental_update = true,
            .deterministic = true};
  }

  void configure(const PlannerSettings& settings) override {
    if (settings.threads < 1)
      throw std::invalid_argument("PlannerSettings: threads = " + std::to_string(settings.threads) +
                                  ", must be >= 1");
    if (!(settings.time_limit_s > 0))
      throw std::invalid_argument("PlannerSettings: time_limit_s = " + std::to_string(settings.time_limit_s) +
                                  ", must be > 0");
    planner_.emplace(settings.planner);
    settings_ = settings;
  }

  void set_map(std::shared_ptr<const costmap::CostGrid> map) override {
    if (!map) throw std::invalid_argument("set_map: no map");
    map_ = std::move(map);
  }

  void update(std::shared_ptr<const costmap::CostGrid> newer) override {
    if (newer && map_ && !(newer->grid() == map_->grid()))
      throw std::invalid_argument("update: the newer map has another grid; use set_map");
    set_map(std::move(newer));
  }

  Route plan(const PlanRequest& request) override {
    if (!map_) throw std::logic_error("plan: no map; call set_map first");
    if (!planner_) planner_.emplace();
    const Plan plan = planner_->plan({.map = map_,
                                      .start = request.start,
                                      .goal = request.goal,
                                      .other_goals = request.other_goals,
                                      .goal_tolerance_m = request.tolerance_m,
                                      .via = request.via,
                                      .time_limit_s = settings_.time_limit_s,
                                      .seed = settings_.seed,
                                      .threads = settings_.threads,
                                      .watch = request.watch});
    return annotated(plan, {.map = *map_, .elevation_m = nullptr, .planner = planner_->name()});
  }

  std::unique_ptr<GlobalPlanner> create() const override { return std::make_unique<Plugin>(); }

 private:
  std::optional<NamedPlanner> planner_;  // none: the default, made when first asked
  PlannerSettings settings_;
  std::shared_ptr<const costmap::CostGrid> map_;
};

}  // namespace
}  // namespace talus::planner

TALUS_EXPORT_PLANNER(talus::planner::Plugin)
