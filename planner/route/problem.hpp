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
#include <talus/planner/route/pose_path.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Input of a planner.
struct Problem {
  std::shared_ptr<const costmap::CostGrid> map;  ///< version of the map; fixed during planning
  maps::Point start;
  maps::Point goal;
  std::vector<maps::Point> other_goals{};  ///< alternative ends of the route, for NamedPlanner
  double goal_tolerance_m = 0.0;           ///< permitted distance of the end from the goal, >= 0
  std::vector<maps::Point> via{};          ///< to be passed in this order
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0
  std::uint64_t seed = 1;                                         ///< same seed, same route
  int threads = 1;                                                ///< >= 1; does not affect the result
  /// Also compute an improved lower bound and search other corridors, which takes a multiple of the time of a
  /// field; otherwise a simple bound.
  bool prove = false;
  /// Causes of completely refused cells, to name the obstruction. If empty, all causes are assigned to
  /// hazards. Must outlive planning.
  HazardsOf hazards{};
  bool whole_field = false;  ///< compute the complete field even on large maps (NamedPlanner)
  ProgressMonitor watch{};
  /// Heading at the start, for planners of drives; empty: any.
  std::optional<double> start_heading_rad{};
  std::optional<double> goal_heading_rad{};  ///< heading at the goal; empty: any
  Kinematics kinematics{};                   ///< motion constraints, for planners of drives
};

/// Result of a planner: a polyline, which annotated() converts to a Route.
struct Plan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;               ///< reason and remedy if there is no route; empty when Found
  std::vector<maps::Point> points;  ///< start, turns, goal
  double cost_J = std::numeric_limits<double>::infinity();  ///< exact cost by MotionCost
  double lower_bound_J = 0.0;                               ///< no route has a lower cost
  double proof_s = 0.0;      ///< time used for Problem::prove: lower bound and search of other corridors
  std::size_t goal = 0;      ///< index of the reached goal: 0 is Problem::goal, then the other goals in order
  bool interrupted = false;  ///< a stop was requested; route and bound are the best so far
  std::optional<Obstruction> obstruction{};  ///< if NoRoute, and two required places are disconnected
  PosePath drive{};  ///< planners of drives: `points` are its chords; otherwise without legs
};

}  // namespace talus::planner
