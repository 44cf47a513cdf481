#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plan/risk_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Runs planRoute() with one of Talus' own planners, or with a plugin (a planner from a shared library) in a
/// child process. Computed data are kept for later routes on the same map or on a newer version of the map.
/// Not thread-safe.
class RoutePlanner {
 public:
  /// Selects one of Talus' own planners by name; an empty name selects the default planner. Throws
  /// std::invalid_argument for an unknown name.
  explicit RoutePlanner(const std::string& planner = {});
  /// Selects a plugin.
  explicit RoutePlanner(PluginPlanner plugin) : planner_(std::move(plugin)) {}

  /// Returns the name of the planner for reports.
  const std::string& name() const noexcept;

  /// Returns the capabilities of the selected own planner. For a plugin, unsupported fields of a request are
  /// rejected in the child process.
  PlannerCapabilities capabilities() const;

  /// Plans a route in the same way as planRoute(), except that `settings.planner` is ignored.
  Route plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
             const PlannerSettings& settings);

 private:
  Problem checkedProblem(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                         const PlannerSettings& settings) const;
  Plan search(const Problem& problem, const PlanRequest& request);

  std::variant<std::unique_ptr<NamedPlanner>, PluginPlanner> planner_;
};

/// Converts a request to the planning problem of a search. The problem contains neither the chassis nor the
/// risk limit of the request.
Problem problemOf(std::shared_ptr<const costmap::CostGrid> map, const PlanRequest& request,
                  const PlannerSettings& settings);

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
