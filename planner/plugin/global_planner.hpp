#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/check/chassis.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/planner/route/route.hpp>

/// Interface of all planners: Talus' own (plan/make_planner.hpp, plan/plan_route.hpp) and planners in shared
/// libraries, which export one object named `talus_planner` (plugin/plugin_export.hpp) and are loaded by
/// plugin/plugin_loader.hpp.
namespace talus {

/// Incremented with every change of this file that is incompatible with older plugins or programs.
inline constexpr int kPlannerInterfaceVersion = 7;

/// Properties of a plugin, and capabilities of its configured planner.
struct PlannerCapabilities {
  int interface_version = kPlannerInterfaceVersion;
  std::string name;                   ///< name of the plugin
  std::string version;                ///< version of the plugin
  std::vector<std::string> planners;  ///< names accepted by configure(), the default first
  std::string planner;                ///< the configured planner, to which the following fields apply
  bool heading_dependent = false;     ///< costs of climbing, descending and crossing a slope differ
  bool lower_bound = false;           ///< a route has a proven optimality gap
  bool via_points = false;            ///< PlanRequest::via is honoured
  bool several_goals = false;         ///< PlanRequest::other_goals is honoured
  bool headings = false;              ///< PlanRequest::start_heading_rad and goal_heading_rad are honoured
  bool turning_radius = false;        ///< PlanRequest::kinematics is honoured
  bool reversing = false;             ///< Kinematics::may_reverse = false is honoured as well
  bool chassis = false;               ///< PlanRequest::chassis is honoured
  bool risk_limit = false;            ///< PlanRequest::risk_limit is honoured
  bool incremental_update = false;    ///< update() reuses unchanged data
  bool deterministic = false;         ///< same input and seed give the same route unless a time limit ends
                                      ///< the search
};

/// Settings of a planner, valid until the next configure().
struct PlannerSettings {
  std::string planner;     ///< one of PlannerCapabilities::planners; empty: the default
  std::uint64_t seed = 1;  ///< seed of sampling planners
  int threads = 1;         ///< >= 1; does not affect the route
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0; returns the best route so far
  bool whole_field = false;  ///< search large maps completely at full resolution
};

/// A chance constraint on the rover's immobilisation.
struct RiskLimit {
  double immobilisation = 0.01;       ///< probability over the whole route, above 0 and below 1
  double correlation_length_m = 5.0;  ///< of the soil, > 0; used if the map's cost has none
};

/// Start, goal and constraints of a route. A field that the configured planner does not honour is refused if
/// set, never ignored: plan() throws std::invalid_argument with the name of the field
/// (plugin/request_check.hpp).
struct PlanRequest {
  maps::Point start;
  maps::Point goal;
  std::vector<maps::Point> other_goals{};     ///< alternative goals; the cheapest is used
  double tolerance_m = 0.0;                   ///< permitted distance of the end from the goal, >= 0
  std::vector<maps::Point> via{};             ///< to be passed in this order
  std::optional<double> start_heading_rad{};  ///< heading at the start; empty: any
  std::optional<double> goal_heading_rad{};   ///< heading at the goal; empty: any
  /// Turning radius, reversing and costs of turning, from planner::kinematicsOn(); empty: turning is free.
  std::optional<planner::Kinematics> kinematics{};
  /// Limits clearance, pitch and roll along the whole motion; null: only the cost map limits the motion.
  std::shared_ptr<const planner::Chassis> chassis{};
  /// Causes of completely refused cells, to name the obstruction: TraversabilityMap::surface().hazards() of
  /// the map used for planning.
  planner::HazardsOf hazards{};
  bool prove = false;  ///< also compute an improved lower bound and search other corridors; slow
  std::optional<RiskLimit> risk_limit{};  ///< empty: only the price of risk applies
  ProgressMonitor watch{};  ///< progress and stop request; after a stop plan() returns Cancelled
};

/// Plans routes on one map. Not thread-safe: use one object per thread, from create(); objects may share a
/// map.
class GlobalPlanner {
 public:
  virtual ~GlobalPlanner() = default;

  virtual PlannerCapabilities capabilities() const = 0;

  /// Sets the settings. Throws std::invalid_argument with field, value and bound, or with the nearest planner
  /// name.
  virtual void configure(const PlannerSettings& settings) = 0;

  /// Sets the map and discards data of the previous map. Throws std::invalid_argument for a null pointer.
  virtual void set_map(std::shared_ptr<const costmap::CostGrid> map) = 0;

  /// Replaces the map by a newer version; unchanged tiles are not processed again. The next plan() is the
  /// same as after set_map(). Throws std::invalid_argument if the grids differ.
  virtual void update(std::shared_ptr<const costmap::CostGrid> newer) = 0;

  /// Returns a route, or the status and reason why there is none. Throws std::logic_error before set_map(),
  /// std::invalid_argument for a field that is out of range or not honoured.
  virtual planner::Route plan(const PlanRequest& request) = 0;

  /// Creates a planner of the same kind with default settings and without a map.
  virtual std::unique_ptr<GlobalPlanner> create() const = 0;
};

}  // namespace talus
