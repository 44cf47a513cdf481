#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/cost_grid.hpp>
#include <talus/maps/grid.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/talus.hpp>

/// The planner plugin: what a shared library offers and what a rover's program asks of it. One page on
/// purpose. A library exports one object named `talus_planner` (planner/plugin_export.hpp);
/// planner/plugin_loader.hpp loads it.
namespace talus {

/// Grows with every change below that an older plugin or program would misclassification_rate.
inline constexpr int kPlannerInterfaceVersion = 2;

/// What a plugin is and can do.
struct PlannerCapabilities {
  int interface_version = kPlannerInterfaceVersion;
  std::string name;                   ///< of the plugin
  std::string version;                ///< of the plugin
  std::vector<std::string> planners;  ///< names that configure() takes, the default first
  bool heading_dependent = false;     ///< climbing, descending and crossing a slope differ
  bool lower_bound = false;           ///< a route says how far from the best it can be at most
  bool via_points = false;            ///< PlanRequest::via is honoured
  bool several_goals = false;         ///< PlanRequest::other_goals is honoured
  bool incremental_update = false;    ///< update() keeps what did not change
  bool deterministic = false;         ///< same input and seed, same route, as long as no clock stops the work
};

/// How to plan; kept until the next configure().
struct PlannerSettings {
  std::string planner;     ///< one of PlannerCapabilities::planners; empty: the default
  std::uint64_t seed = 1;  ///< of planners that sample
  int threads = 1;         ///< >= 1; the route does not depend on it
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0; stop and give the best so far
};

/// Where to drive.
struct PlanRequest {
  maps::Point start;
  maps::Point goal;
  std::vector<maps::Point>
      other_goals{};               ///< the route may end at any of these as well: the cheapest is taken
  double tolerance_m = 0.0;        ///< it may end this far from the goal, >= 0
  std::vector<maps::Point> via{};  ///< to be passed in this order
  ProgressMonitor watch{};  ///< progress, and the cancel check: request a stop and plan() ends Cancelled
};

/// Plans routes over one map. Not thread-safe: one object a thread, create() makes more; they may share a
/// map.
class GlobalPlanner {
 public:
  virtual ~GlobalPlanner() = default;

  virtual PlannerCapabilities capabilities() const = 0;

  /// Takes settings; throws std::invalid_argument naming field, value and bound, or the nearest planner's
  /// name.
  virtual void configure(const PlannerSettings& settings) = 0;

  /// Takes a map; what was known of another map is forgotten. Throws std::invalid_argument without one.
  virtual void set_map(std::shared_ptr<const costmap::CostGrid> map) = 0;

  /// Takes a newer version of the map; tiles it shares with the old one are not looked at again.
  /// The next plan() is the same as after set_map(). Throws std::invalid_argument when the grids differ.
  virtual void update(std::shared_ptr<const costmap::CostGrid> newer) = 0;

  /// A route, or the status and reason why there is none. Throws std::logic_error before set_map().
  virtual planner::Route plan(const PlanRequest& request) = 0;

  /// A fresh planner of the same kind, with default settings and no map.
  virtual std::unique_ptr<GlobalPlanner> create() const = 0;
};

}  // namespace talus
