#pragma once

#include <memory>
#include <optional>

#include <talus/planner/plan/route_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Adapter that offers Talus' own planners through the interface GlobalPlanner. The routes are equal to those
/// of planRoute().
class OwnPlanner final : public GlobalPlanner {
 public:
  PlannerCapabilities capabilities() const override;
  void configure(const PlannerSettings& settings) override;
  void set_map(std::shared_ptr<const costmap::CostGrid> map) override;
  void update(std::shared_ptr<const costmap::CostGrid> newer) override;
  Route plan(const PlanRequest& request) override;
  std::unique_ptr<GlobalPlanner> create() const override { return std::make_unique<OwnPlanner>(); }

 private:
  std::optional<RoutePlanner> planner_;  // empty: the default planner, created on first use
  PlannerSettings settings_;
  std::shared_ptr<const costmap::CostGrid> map_;
};

}  // namespace talus::planner
