#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/route.hpp>

namespace talus {

/// Interface of all planners. Talus' own planners are called by
/// plan/plan_route.hpp. A planner in a shared library is exported as an object named `talus_planner`
/// (plugin/plugin_export.hpp) and is loaded by loadPlugin().

/// Version of this interface. The number increases with every change of this file that is incompatible with
/// older plugins or programs.
inline constexpr int kPlannerInterfaceVersion = 9;

/// Properties of a plugin (a shared library with planners), and capabilities of its configured planner.
struct PlannerCapabilities {
  int interface_version = kPlannerInterfaceVersion;  ///< interface version for which the plugin was built
  std::string name;                                  ///< name of the plugin
  std::string version;                               ///< version of the plugin
  std::vector<std::string> planners;  ///< names accepted by configure(), the default planner first
  std::string planner;                ///< name of the configured planner, to which the following fields apply
  bool heading_dependent = false;     ///< the cost of a motion depends on its heading on a slope
  bool lower_bound = false;           ///< the planner proves an optimality gap of its routes
  bool via_points = false;            ///< the planner supports PlanRequest::via
  bool several_goals = false;         ///< the planner supports PlanRequest::other_goals
  bool headings = false;        ///< the planner supports PlanRequest::start_heading_rad and goal_heading_rad
  bool turning_radius = false;  ///< the planner supports PlanRequest::kinematics
  bool reversing = false;       ///< the planner also supports Kinematics::may_reverse = false
  bool chassis = false;         ///< the planner supports PlanRequest::chassis
  bool risk_limit = false;      ///< the planner supports PlanRequest::risk_limit
  bool incremental_update = false;  ///< update() reuses data of unchanged parts of the map
  /// Equal input and seed give equal routes, unless a time limit ends the search.
  bool deterministic = false;
};

/// Settings of a planner. They are valid until the next configure().
struct PlannerSettings {
  /// Name of the planner, from PlannerCapabilities::planners; empty: the default planner.
  std::string planner;
  std::uint64_t seed = 1;  ///< seed of the random numbers of sampling planners
  int threads = 1;         ///< number of threads, >= 1; does not affect the route
  /// Time limit of a plan, > 0; at the limit the best route found is returned.
  double time_limit_s = std::numeric_limits<double>::infinity();

  bool operator==(const PlannerSettings&) const = default;
};

/// Chance constraint: upper limit of the probability that the rover is immobilised on the route.
struct RiskLimit {
  double immobilisation = 0.01;  ///< largest permitted probability over the whole route, above 0 and below 1
  /// Correlation length of the soil, > 0; used if the map's cost function has none.
  double correlation_length_m = 5.0;
};

/// Start, goal and constraints of a route. Points are map coordinates [m]. If a field is set that the
/// configured planner does not support, plan() throws std::invalid_argument with the name of the field
/// (plugin/request_check.hpp); fields are never ignored.
struct PlanRequest {
  maps::Point start;
  maps::Point goal;
  /// Alternative goals; the route leads to the goal with the lowest cost.
  std::vector<maps::Point> other_goals{};
  double tolerance_m = 0.0;        ///< permitted distance of the end of the route from the goal, >= 0
  std::vector<maps::Point> via{};  ///< via points, through which the route passes in this order
  std::optional<double> start_heading_rad{};  ///< heading of the rover at the start; empty: any heading
  std::optional<double> goal_heading_rad{};   ///< heading of the rover at the goal; empty: any heading
  /// Turning radius, permission to reverse, and costs of turning, from planner::kinematicsOn(). Empty: the
  /// planner assumes that turning is free.
  std::optional<planner::Kinematics> kinematics{};
  /// Chassis model that limits ground clearance, pitch and roll along the whole motion. Null: only the cost
  /// map limits the motion.
  std::shared_ptr<const planner::Chassis> chassis{};
  /// Function that returns the hazard for which the rover may not enter a cell on any heading, used to
  /// describe an obstruction: TraversabilityMap::surface().hazards() of the map used for planning.
  planner::HazardsOf hazards{};
  /// true: also compute an improved lower bound and search routes on other sides of obstacles; slow.
  bool prove = false;
  /// With `prove`: relative gap between cost and lower bound at which the search ends, [0, 1); 0: as small as the
  /// usual work allows.
  double gap = 0.0;
  /// Limit of the immobilisation risk; empty: risk enters only through its weight in the cost.
  std::optional<RiskLimit> risk_limit{};
  /// Receives the progress and requests a stop. After a stop plan() returns the status Cancelled, or the best
  /// route found with Route::interrupted.
  ProgressMonitor watch{};
};

/// Planner of routes on one map. Not thread-safe: use one object per thread, from create(); the objects may
/// share a map.
class GlobalPlanner {
 public:
  virtual ~GlobalPlanner() = default;

  /// Returns the properties of the plugin and the capabilities of the configured planner.
  virtual PlannerCapabilities capabilities() const = 0;

  /// Sets the settings. Throws std::invalid_argument with field, value and bound for a value out of range,
  /// and with the most similar name for an unknown planner.
  virtual void configure(const PlannerSettings& settings) = 0;

  /// Sets the map and discards data of the previous map. Throws std::invalid_argument if `map` is null.
  virtual void set_map(std::shared_ptr<const costmap::CostGrid> map) = 0;

  /// Replaces the map by the newer version `newer`; unchanged tiles are not processed again. The next plan()
  /// returns the same route as after set_map(). Throws std::invalid_argument if the grids of both versions
  /// differ.
  virtual void update(std::shared_ptr<const costmap::CostGrid> newer) = 0;

  /// Returns a route, or the status and the reason why there is no route. Throws std::logic_error before
  /// set_map(), and std::invalid_argument for a field that is out of range or not supported.
  virtual planner::Route plan(const PlanRequest& request) = 0;

  /// Creates a planner of the same kind with default settings and without a map.
  virtual std::unique_ptr<GlobalPlanner> create() const = 0;
};

}  // namespace talus

namespace talus::planner {

/// Loads the shared library `path` and creates its planner. The library stays loaded for the lifetime of the
/// planner and of all planners that it created. If a field of a request is set that the planner does not
/// support, an exception is thrown before the plugin is called. Throws talus::InputError
/// with the file name if the file is missing, is not a library, exports no `talus_planner`, or was built for
/// another interface version. The library is first loaded and unloaded in a child process with a memory limit
/// of 4 GiB. InputError is also thrown if this trial crashes or takes longer than `trial_s` > 0 seconds of
/// wall time.
std::unique_ptr<GlobalPlanner> loadPlugin(const std::string& path, double trial_s = 10.0);

/// Throws std::invalid_argument with the name of the first field of `request` that is out of range, or that
/// is set although a planner with the capabilities `offers` does not support it. Every planner of
/// loadPlugin() and Planner call this function.
void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers);

/// Returns `settings` after a check of the ranges. Throws std::invalid_argument with field, value and bound.
const PlannerSettings& validated(const PlannerSettings& settings);

}  // namespace talus::planner
