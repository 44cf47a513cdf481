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

/// The interface of all planners: Talus' own (plan/make_planner.hpp, plan/plan_route.hpp) and those in a shared library,
/// which exports one object named `talus_planner` (plugin/plugin_export.hpp) that plugin/plugin_loader.hpp loads.
namespace talus {

/// Grows with every change below that an older plugin or program would misread.
inline constexpr int kPlannerInterfaceVersion = 6;

/// What a plugin is, and what the planner that it is configured for can do.
struct PlannerCapabilities {
  int interface_version = kPlannerInterfaceVersion;
  std::string name;                   ///< of the plugin
  std::string version;                ///< of the plugin
  std::vector<std::string> planners;  ///< names that configure() takes, the default first
  std::string planner;                ///< the one configured now: what follows holds for it
  bool heading_dependent = false;     ///< climbing, descending and crossing a slope differ
  bool lower_bound = false;           ///< a route has a proven optimality gap
  bool via_points = false;            ///< PlanRequest::via is honoured
  bool several_goals = false;         ///< PlanRequest::other_goals is honoured
  bool headings = false;              ///< PlanRequest::start_heading_rad and goal_heading_rad are honoured
  bool turning_radius = false;        ///< PlanRequest::kinematics is honoured
  bool reversing = false;             ///< Kinematics::may_reverse = false is honoured as well
  bool chassis = false;               ///< PlanRequest::chassis is honoured
  bool risk_limit = false;            ///< PlanRequest::risk_limit is honoured
  bool incremental_update = false;    ///< update() keeps what did not change
  bool deterministic = false;         ///< same input and seed, same route, as long as no clock stops the work
};

/// How to plan; kept until the next configure().
struct PlannerSettings {
  std::string planner;     ///< one of PlannerCapabilities::planners; empty: the default
  std::uint64_t seed = 1;  ///< of planners that sample
  int threads = 1;         ///< >= 1; the route does not depend on it
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0; stop and give the best so far
  bool whole_field = false;  ///< search the whole map at full resolution even where it is large
};

/// A chance constraint on the rover's immobilisation.
struct RiskLimit {
  double immobilisation = 0.01;       ///< probability over the whole route, above 0 and below 1
  double correlation_length_m = 5.0;  ///< of the soil, > 0; used on maps whose cost does not state its own
};

/// Where to drive, and how. A field that the configured planner does not honour is refused when it is set,
/// never ignored: plan() throws std::invalid_argument naming it (plugin/request_check.hpp).
struct PlanRequest {
  maps::Point start;
  maps::Point goal;
  std::vector<maps::Point>
      other_goals{};               ///< the route may end at any of these as well: the cheapest is taken
  double tolerance_m = 0.0;        ///< it may end this far from the goal, >= 0
  std::vector<maps::Point> via{};  ///< to be passed in this order
  std::optional<double> start_heading_rad{};  ///< heading at the start; none: any
  std::optional<double> goal_heading_rad{};   ///< heading at the goal; none: any
  /// Turning radius, reversing and what turning takes, from planner::kinematicsOn(); none: turning is free.
  std::optional<planner::Kinematics> kinematics{};
  /// Clearance, pitch and roll are kept along the whole motion; none: the cost map's own judgement holds.
  std::shared_ptr<const planner::Chassis> chassis{};
  /// Why cells are refused whole, to name what closes a way: of the map that is planned on, TraversabilityMap::surface().hazards().
  planner::HazardsOf hazards{};
  bool prove = false;  ///< also work out the best lower bound and look for other corridors: not for a loop
  std::optional<RiskLimit> risk_limit{};  ///< none: risk counts by its price alone
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

  /// A route, or the status and reason why there is none. Throws std::logic_error before set_map(),
  /// std::invalid_argument for a field out of its range or not honoured.
  virtual planner::Route plan(const PlanRequest& request) = 0;

  /// A fresh planner of the same kind, with default settings and no map.
  virtual std::unique_ptr<GlobalPlanner> create() const = 0;
};

}  // namespace talus
