#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/planner/planner.hpp>
#include <talus/planner/plugin/plugin_export.hpp>

namespace talus::planner {
namespace {

// Talus' own planners through the interface GlobalPlanner. The routes are equal to those of Planner.
class OwnPlanner final : public GlobalPlanner {
 public:
  PlannerCapabilities capabilities() const override {
    return planner_ ? planner_->capabilities() : Planner().capabilities();
  }
  void configure(const PlannerSettings& settings) override { planner_ = Planner(settings); }
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
    return planner_->plan(map_, request);
  }
  std::unique_ptr<GlobalPlanner> create() const override { return std::make_unique<OwnPlanner>(); }

 private:
  std::optional<Planner> planner_;  // empty: the default planner, made at its first use
  std::shared_ptr<const costmap::CostGrid> map_;
};

}  // namespace
}  // namespace talus::planner

TALUS_EXPORT_PLANNER(talus::planner::OwnPlanner)
