#pragma once

#include <memory>
#include <optional>

#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/named_planner.hpp>

namespace talus::planner {

/// Talus' own planners behind the interface that embedders use. What leaves has passed checkedPlan().
class OwnPlanner final : public GlobalPlanner {
 public:
  PlannerCapabilities capabilities() const override;
  void configure(const PlannerSettings& settings) override;
  void set_map(std::shared_ptr<const costmap::CostGrid> map) override;
  void update(std::shared_ptr<const costmap::CostGrid> newer) override;
  Route plan(const PlanRequest& request) override;
  std::unique_ptr<GlobalPlanner> create() const override { return std::make_unique<OwnPlanner>(); }

 private:
  Problem problemOf(const PlanRequest& request) const;

  std::optional<NamedPlanner> planner_;  // none: the default, made when first asked
  PlannerSettings settings_;
  std::shared_ptr<const costmap::CostGrid> map_;
};

/// The settings, once they keep their ranges. Throws std::invalid_argument naming field, value and bound.
const PlannerSettings& validated(const PlannerSettings& settings);

}  // namespace talus::planner
