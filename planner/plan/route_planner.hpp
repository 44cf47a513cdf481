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

/// Runs planRoute() with one of Talus' own planners, or with a plugin in a child process. Computed data are
/// cached for later routes on the map or a newer version of the map. Not thread-safe.
class RoutePlanner {
 public:
  /// Uses one of Talus' own planners; empty: the default. Throws std::invalid_argument for an unknown name.
  explicit RoutePlanner(const std::string& planner = {});
  explicit RoutePlanner(PluginPlanner plugin) : planner_(std::move(plugin)) {}

  /// Returns the name of the planner for reports.
  const std::string& name() const noexcept;

  /// Capabilities of the own planner. A plugin refuses unsupported fields in its own process.
  PlannerCapabilities capabilities() const;

  /// Plans as planRoute(); the planner named in the settings is ignored.
  Route plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
             const PlannerSettings& settings);

  /// Computes paretoSet() for the request without its risk limit; the chassis is honoured.
  std::vector<ParetoRoute> paretoRoutes(const std::shared_ptr<const costmap::CostGrid>& map,
                                        PlanRequest request, const PlannerSettings& settings, int steps);

 private:
  Problem checkedProblem(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                         const PlannerSettings& settings) const;
  Plan search(const Problem& problem, const PlanRequest& request);

  std::variant<std::unique_ptr<NamedPlanner>, PluginPlanner> planner_;
};

/// Converts a request to the input of a search, without chassis and risk limit.
Problem problemOf(std::shared_ptr<const costmap::CostGrid> map, const PlanRequest& request,
                  const PlannerSettings& settings);

}  // namespace talus::planner
