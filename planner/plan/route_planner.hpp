#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plan/risk_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// What planRoute() does, by one of Talus' own planners or by a plugin's in a child process. What the planner computed
/// is kept for the next route over the map or a newer version of it. Not thread-safe.
class RoutePlanner {
 public:
  /// One of Talus' own planners; empty: the default. Throws std::invalid_argument for a name that is not on offer.
  explicit RoutePlanner(const std::string& planner = {});
  explicit RoutePlanner(PluginPlanner plugin) : planner_(std::move(plugin)) {}

  /// Of the planner, for reports.
  const std::string& name() const noexcept;

  /// Of one of Talus' own planners as such. A plugin refuses the rest of what it does not honour in its process.
  PlannerCapabilities capabilities() const;

  /// planRoute(); the settings' planner is not read.
  Route plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
             const PlannerSettings& settings);

  /// paretoSet() of the request without its risk limit; the chassis is kept.
  std::vector<ParetoRoute> paretoRoutes(const std::shared_ptr<const costmap::CostGrid>& map,
                                        PlanRequest request, const PlannerSettings& settings, int steps);

 private:
  Problem checkedProblem(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                         const PlannerSettings& settings) const;
  Plan search(const Problem& problem, const PlanRequest& request);

  std::variant<std::unique_ptr<NamedPlanner>, PluginPlanner> planner_;
};

/// The request as the input of a search. Chassis and risk limit are not part of that.
Problem problemOf(std::shared_ptr<const costmap::CostGrid> map, const PlanRequest& request,
                  const PlannerSettings& settings);

}  // namespace talus::planner
