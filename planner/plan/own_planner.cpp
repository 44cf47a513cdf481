#include <stdexcept>
#include <utility>

#include <talus/planner/plan/own_planner.hpp>
#include <talus/planner/plugin/request_check.hpp>

namespace talus::planner {

PlannerCapabilities OwnPlanner::capabilities() const {
  return planner_ ? planner_->capabilities() : RoutePlanner().capabilities();
}

void OwnPlanner::configure(const PlannerSettings& settings) {
  RoutePlanner next(validated(settings).planner);  // may throw; nothing is changed before
  planner_.emplace(std::move(next));
  settings_ = settings;
}

void OwnPlanner::set_map(std::shared_ptr<const costmap::CostGrid> map) {
  if (!map) throw std::invalid_argument("set_map: no map");
  map_ = std::move(map);
}

void OwnPlanner::update(std::shared_ptr<const costmap::CostGrid> newer) {
  if (newer && map_ && !(newer->grid() == map_->grid()))
    throw std::invalid_argument("update: the newer map has another grid; use set_map");
  set_map(std::move(newer));
}

Route OwnPlanner::plan(const PlanRequest& request) {
  if (!map_) throw std::logic_error("plan: no map; call set_map first");
  if (!planner_) planner_.emplace();
  return planner_->plan(map_, request, settings_);
}

}  // namespace talus::planner
