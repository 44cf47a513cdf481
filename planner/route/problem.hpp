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

/// The input of a planner.
struct Problem {
  std::shared_ptr<const costmap::CostGrid> map;  ///< the version to plan on; pinned while planning runs
  maps::Point start;
  maps::Point goal;
  std::vector<maps::Point> other_goals{};  ///< a route may end at any of these as well: NamedPlanner's does
  double goal_tolerance_m = 0.0;           ///< a route may end this far from the goal, >= 0
  std::vector<maps::Point> via{};          ///< to be passed in this order
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0
  std::uint64_t seed = 1;                                         ///< same seed, same route
  int threads = 1;                                                ///< >= 1; the answer does not depend on it
  /// Also work out the best lower bound and look for other corridors, for some times the time of a field; else a simple bound.
  bool prove = false;
  /// Why cells are refused whole, to name what closes a way; none: all of it counts as hazards. Planned only as long as it lives.
  HazardsOf hazards{};
  bool whole_field = false;  ///< settle the whole map even where it is large (NamedPlanner)
  ProgressMonitor watch{};
  /// Which way the rover looks; for planners of drives, any if none.
  std::optional<double> start_heading_rad{};
  std::optional<double> goal_heading_rad{};  ///< the same on arrival
  Kinematics kinematics{};                   ///< what planners of drives keep
};

/// What a planner answers: the bare polyline; annotated() makes a Route of it.
struct Plan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;               ///< why there is no route and what to do about it; empty when Found
  std::vector<maps::Point> points;  ///< start, turns, goal
  double cost_J = std::numeric_limits<double>::infinity();  ///< exact, by MotionCost
  double lower_bound_J = 0.0;                               ///< no route costs less
  double proof_s = 0.0;  ///< that Problem::prove took: the bound and the search of other corridors
  std::size_t goal = 0;  ///< which goal it ends at: 0 is Problem::goal, then the other goals in order
  bool interrupted =
      false;  ///< a stop was requested before the work was done: the best route and bound so far
  std::optional<Obstruction>
      obstruction{};  ///< of NoRoute, where two required places are cut off from each other
  PosePath drive{};   ///< of planners of drives: `points` are its chords; no legs for the others
};

}  // namespace talus::planner
