#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Routes in position and heading (poses joined by arcs), with their costs and sampled poses.

/// Drive: a sequence of arcs and turns in place that begins at the pose `start`.
struct PosePath {
  /// Leg of a drive: an arc, or a turn in place, which has an arc of zero length.
  struct Leg {
    Arc arc;
    double turn_rad = 0.0;  ///< angle of the turn in place, left > 0; requires arc.length_m = 0
  };
  Pose start;
  std::vector<Leg> legs;
};

/// Returns the pose after a leg that begins at the pose `from`.
Pose after(const Pose& from, const PosePath::Leg& leg) noexcept;

/// Cost of drives on one cost map for the kinematics of a rover. The cost is MotionCost along chords of at
/// most half a cell and 0.1 rad, plus the costs of turning and of cusps (changes between forward and
/// reverse). Driving in reverse costs as much as driving forward in the same direction, because the rover is
/// assumed to be symmetric. A turn in place is allowed only if the map permits every heading that the rover
/// passes. Immutable; safe to share between threads. `cost` must outlive the object.
class PoseCost {
 public:
  PoseCost(const MotionCost& cost, const Kinematics& kinematics);

  /// Returns the cost [J] of one leg from the pose `from`; infinite if a part of the leg is not allowed.
  double operator()(const Pose& from, const PosePath::Leg& leg) const noexcept;

  /// Returns the cost [J] of a drive, including cusps; infinite if a part of the drive is not allowed.
  double operator()(const PosePath& path) const noexcept;

  /// Returns the shortest path from `from` to `to` regardless of the ground. With a turning radius the path
  /// is that of ShortestCurves. Without a turning radius the rover turns in place, drives straight, and turns
  /// in place; it drives in reverse if reversing is permitted and reduces the turns. `forward` true: without
  /// reversing.
  std::vector<PosePath::Leg> direct(const Pose& from, const Pose& to, bool forward = false) const;

  /// Returns the cost [J] of a change between forward and reverse.
  double cusp_J() const noexcept { return cost_.map().cost().cost_J(kinematics_.cusp); }
  /// Returns the kinematics of the rover.
  const Kinematics& kinematics() const noexcept { return kinematics_; }
  /// Returns the cost of straight motions.
  const MotionCost& motion() const noexcept { return cost_; }

 private:
  double arc(const Pose& from, const Arc& arc) const noexcept;
  double turnInPlace(const Pose& from, double turn_rad) const noexcept;
  const TurnEfforts& turnsAt(maps::Point place) const noexcept;

  const MotionCost& cost_;
  Kinematics kinematics_;
  std::optional<ShortestCurves> curves_;  // empty: the rover turns in place
  double step_m_;
};

/// Returns the direction of motion of a leg: +1 forward, -1 in reverse, 0 for a turn in place.
int direction(const PosePath::Leg& leg) noexcept;

/// Returns poses along a drive, at most `step_m` apart, including the ends of its legs.
std::vector<Pose> sampled(const PosePath& path, double step_m);

/// Returns the poses that PoseCost connects by straight segments: the ends of straight legs, and the ends of
/// the chords of arcs.
std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map);

/// Returns the numbers of cusps and turns in place, and the largest curvature, of a drive.
RouteShape shape(const PosePath& path) noexcept;

/// Returns the length of a drive in the map plane [m].
double length_m(const PosePath& path) noexcept;

/// Returns the names of the available planners, the default first: "field" (polylines from a cost-to-go
/// field), "hybrid" (drives with a turning radius), and the planners of OMPL by their class names.
const std::vector<std::string>& plannerNames();

/// Returns the canonical planner name for the user input `asked`. The comparison ignores case, '-', '_' and
/// blanks; "RRT*" means "RRTstar"; empty input means the default. Throws std::invalid_argument with the
/// reason for an OMPL planner that is not suitable for this application, and with the most similar name, if
/// any, for an unknown planner.
std::string plannerName(std::string_view asked);

/// Planning problem: the input of a planner. Points are map coordinates [m].
struct Problem {
  /// Version of the cost map, constant during planning; not null.
  std::shared_ptr<const costmap::CostGrid> map;
  maps::Point start;                       ///< start of the route
  maps::Point goal;                        ///< goal of the route
  std::vector<maps::Point> other_goals{};  ///< alternative goals; only NamedPlanner uses them
  double goal_tolerance_m = 0.0;           ///< permitted distance of the end of the route from the goal, >= 0
  std::vector<maps::Point> via{};          ///< via points, through which the route passes in this order
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< time limit of planning, > 0
  std::uint64_t seed = 1;  ///< seed of random numbers; equal seeds give equal routes
  int threads = 1;         ///< number of threads, >= 1; does not affect the result
  /// True: the planner also computes a lower bound and searches its region for a cheaper route, which takes
  /// several times as long as the cost-to-go field. False: no lower bound.
  bool prove = false;
  double gap = 0.0;  ///< relative gap at which the proof ends, [0, 1); 0: as small as the usual work allows
  /// Function that returns the hazard for which the rover may not enter a cell on any heading, used to
  /// describe an obstruction. If empty, every such cell is attributed to hazards. Must outlive planning.
  HazardsOf hazards{};
  ProgressMonitor watch{};  ///< receives the progress and requests a stop
  /// Heading of the rover at the start, for planners of drives (routes with a turning radius); empty: any
  /// heading.
  std::optional<double> start_heading_rad{};
  /// Heading of the rover at the goal, for planners of drives; empty: any heading.
  std::optional<double> goal_heading_rad{};
  Kinematics kinematics{};  ///< constraints on the motion of the rover, for planners of drives
};

/// Result of a planner: a polyline in the map plane. annotated() converts a plan to a Route.
struct Plan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;               ///< reason and remedy if there is no route; empty if the status is Found
  std::vector<maps::Point> points;  ///< vertices of the polyline, from start to goal
  /// Exact cost of the polyline by MotionCost, or of the drive by PoseCost.
  double cost_J = std::numeric_limits<double>::infinity();
  double lower_bound_J = 0.0;  ///< proven lower bound of the cost of every route of the problem
  double proof_s = 0.0;        ///< time used for Problem::prove
  std::size_t goal = 0;        ///< index of the reached goal: 0 is Problem::goal, k > 0 is other_goals[k - 1]
  bool interrupted = false;    ///< true: a stop was requested; route and bound are the best found until then
  bool refused = false;        ///< true: the planner gave a route, which the route check refuses
  std::optional<Obstruction> obstruction{};  ///< reason of NoRoute, if two required points are not connected
  /// Drive with arcs and turns in place, of which `points` are the chords; no legs for a polyline.
  PosePath drive{};
};

/// Returns a plan without a route, with the given status and reason.
inline Plan failedPlan(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

/// Returns the failed plan of a search that `stop` ended: status Cancelled or TimedOut.
inline Plan cancelledPlan(const StopCheck& stop) {
  if (stop.cancelled()) return failedPlan(RouteStatus::Cancelled, "cancelled before a route was found");
  return failedPlan(RouteStatus::TimedOut, "the time limit passed before a route was found; increase it");
}

/// Returns the plan unchanged, or a plan with status NoneFound if the cost of the plan is infinite. The cost
/// of a Found plan is infinite if the rover would tip during a turn between two legs.
inline Plan withoutTipping(Plan plan) {
  if (plan.status != RouteStatus::Found || std::isfinite(plan.cost_J)) return plan;
  return failedPlan(RouteStatus::NoneFound,
                    "no route found, nor a proof that there is none: on the one found, turns pass headings "
                    "in which the rover tips; "
                    "choose other places, or a rover with a lower centre of mass");
}

/// Plans a route through the via points of `problem`, leg by leg, with `plan_leg`. A leg starts at the end of
/// the previous leg and ends exactly at the next via point or the goal; only the last leg uses the goal
/// tolerance. The cost is the sum of the costs of the legs and of the turns at via points; the lower bound is
/// the sum of the lower bounds of the legs. If a leg is not Found, its plan is returned, with the number of
/// the via point, from 1, in the reason. Progress is reported to Problem::watch.
Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg);

}  // namespace talus::planner
