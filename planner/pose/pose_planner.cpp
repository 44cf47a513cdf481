#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/pose/pose_planner.hpp>
#include <talus/planner/pose/pose_shortcut.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/route/stop_check.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::planner {
namespace {

// Smallest spacing of the poses between which curves are fitted, in cells and in turning radii.
constexpr double kPose_cells = 4.0;
constexpr double kPose_radii = 2.0;
// Additional radii [cells] tried for a rover that can turn in place.
constexpr std::array kBend_cells{1.5, 4.0};
// Largest number of poses expanded by the search if a drive is already known.
constexpr std::uint64_t kBeside = 50'000;

Plan ended(PosePlan leg) {
  Plan plan;
  plan.status = leg.status;
  plan.reason = std::move(leg.reason);
  return plan;
}

Pose endOf(const PosePath& path) {
  Pose pose = path.start;
  for (const PosePath::Leg& leg : path.legs) pose = after(pose, leg);
  return pose;
}

void append(PosePath& whole, const PosePath& leg) {
  if (whole.legs.empty()) whole.start = leg.start;
  whole.legs.insert(whole.legs.end(), leg.legs.begin(), leg.legs.end());
}

// Poses along a polyline; at a corner, the heading is midway between the adjacent legs.
std::vector<Pose> posesAlong(const std::vector<maps::Point>& points, const PoseProblem& asked) {
  std::vector<Pose> poses;
  const auto heading = [&](std::size_t i) {
    return std::atan2(points[i + 1].y_m - points[i].y_m, points[i + 1].x_m - points[i].x_m);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double out = heading(std::min(i, points.size() - 2)), in = heading(i == 0 ? 0 : i - 1);
    poses.push_back({points[i], in + 0.5 * std::remainder(out - in, 2.0 * std::numbers::pi)});
  }
  poses.front().heading_rad = asked.start_heading_rad.value_or(poses.front().heading_rad);
  poses.back().heading_rad = asked.goal_heading_rad.value_or(poses.back().heading_rad);
  return poses;
}

// Shortest curves from pose to pose, shortened as a whole. Curves that are not allowed are bridged by others.
PosePath fitted(const std::vector<Pose>& poses, const PoseCost& cost, const ShortenOptions& options) {
  PosePath path{.start = poses.front(), .legs = {}};
  for (std::size_t i = 1; i < poses.size(); ++i)
    for (const PosePath::Leg& leg : cost.direct(poses[i - 1], poses[i])) path.legs.push_back(leg);
  return shortened(path, cost, options);
}

// Drive along a polyline with the cost's turning radius; for radius 0, straight legs and turns in place.
PosePath along(const std::vector<maps::Point>& points, const PoseProblem& asked, const PoseCost& cost,
               const StopCheck& stop) {
  const double cell_m = asked.map->grid().resolution_m, radius_m = cost.kinematics().turning_radius_m;
  const auto apart = subdivided(points, std::max(kPose_cells * cell_m, kPose_radii * radius_m));
  if (radius_m <= 0.0) return turningPath(apart, {asked.start_heading_rad, asked.goal_heading_rad}, cost);
  return fitted(
      posesAlong(apart, asked), cost,
      {.joint_m = kPose_cells * cell_m, .cheapest_J_per_m = cheapestMetre_J(*asked.map), .stop = stop});
}

// A rover that can turn in place may also follow arcs, which need no stop.
PosePlan cheapestAlong(const std::vector<maps::Point>& points, const PoseProblem& asked,
                       const StopCheck& stop) {
  const MotionCost motion(asked.map);
  std::vector<double> radii_m{asked.kinematics.turning_radius_m};
  if (radii_m.front() <= 0.0)
    for (const double cells : kBend_cells) radii_m.push_back(cells * asked.map->grid().resolution_m);
  PosePlan best;
  for (const double radius_m : radii_m) {
    Kinematics kinematics = asked.kinematics;
    kinematics.turning_radius_m = radius_m;
    const PoseCost cost(motion, kinematics);
    if (best.status == RouteStatus::Found && stop()) break;
    PosePath path = along(points, asked, cost, stop);
    const double cost_J = cost(path);
    const bool cheaper = best.status != RouteStatus::Found || cost_J < best.cost_J;
    if (path.legs.empty() || !std::isfinite(cost_J) || !cheaper) continue;
    if (!mayBeDriven(*asked.map, path, asked.kinematics)) continue;
    best.status = RouteStatus::Found;
    best.path = std::move(path);
    best.cost_J = cost_J;
  }
  return best;
}

}  // namespace

// If the radius is small compared with the bends of the route, turning costs little, and the any-angle route
// is a better start than the search with its discrete headings. The any-angle route also passes gaps that
// motions of one fixed length miss.
PosePlan PosePlanner::alongRoute(const PoseProblem& asked, const Problem& problem) {
  const StopCheck stop(asked.watch, asked.time_limit_s);
  Problem free = problem;
  free.start = asked.start;
  free.goal = asked.goal;
  free.via.clear();
  free.goal_tolerance_m = 0.0;
  free.time_limit_s = asked.time_limit_s;
  free.prove = false;
  const Plan route = field_.plan(free);
  if (route.status == RouteStatus::Found && route.points.size() > 1)
    return cheapestAlong(route.points, asked, stop);
  PosePlan none;
  // What is proven for all headings holds for drives, too.
  if (route.status == RouteStatus::NoRoute || route.status == RouteStatus::StartInvalid ||
      route.status == RouteStatus::GoalInvalid)
    none.status = route.status, none.reason = route.reason;
  return none;
}

PosePlan PosePlanner::drivenTo(PoseProblem asked, const Problem& problem, maps::Point end) {
  const TimeLeft time(asked.time_limit_s);
  asked.goal = end;
  PosePlan along = alongRoute(asked, problem);
  if (!along.reason.empty()) return along;
  const bool known = along.status == RouteStatus::Found;
  if (known) asked.most_expanded = kBeside;
  asked.time_limit_s = time.share_s();
  PosePlan leg = search_.plan(asked);
  if (leg.status == RouteStatus::Cancelled && !known) return leg;
  if (known && (leg.status != RouteStatus::Found || along.cost_J < leg.cost_J)) leg = std::move(along);
  return leg;
}

PosePlan PosePlanner::drivenWithin(PoseProblem asked, const Problem& problem) {
  const TimeLeft time(asked.time_limit_s);
  Problem free = problem;
  free.start = asked.start;
  free.via.clear();
  free.time_limit_s = asked.time_limit_s;
  free.prove = false;
  const Plan route = field_.plan(free);
  PosePlan best;
  best.status = route.status;
  best.reason = route.reason;
  if (route.status != RouteStatus::Found) return best;
  asked.time_limit_s = time.share_s();
  best = drivenTo(asked, problem, route.points.back());
  if (best.status == RouteStatus::Cancelled || route.points.back() == problem.goal ||
      !MotionCost(problem.map).allowed(problem.goal))
    return best;
  asked.time_limit_s = time.share_s();
  PosePlan exact = drivenTo(asked, problem, problem.goal);
  const bool better =
      exact.status == RouteStatus::Found && (best.status != RouteStatus::Found || exact.cost_J < best.cost_J);
  return better ? exact : best;
}

Plan PosePlanner::plan(const Problem& problem) {
  if (!problem.map) throw std::invalid_argument("DrivePlanner: no map");
  terramech::RangeCheck("DrivePlanner")
      .zeroOrWithin("turning_radius_m", problem.kinematics.turning_radius_m,
                    {terramech::kSmallestTurn_m, terramech::kLargestTurn_m});
  const TimeLeft time(problem.time_limit_s);
  std::vector<maps::Point> stops = problem.via;
  stops.push_back(problem.goal);
  PoseProblem asked{.map = problem.map,
                    .start = problem.start,
                    .goal = {},
                    .start_heading_rad = problem.start_heading_rad,
                    .goal_heading_rad = {},
                    .kinematics = problem.kinematics,
                    .time_limit_s = problem.time_limit_s,
                    .watch = problem.watch};
  Plan whole;
  whole.status = RouteStatus::Found;
  whole.drive.start = {problem.start, problem.start_heading_rad.value_or(0.0)};
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const bool last = i + 1 == stops.size();
    const double tolerance_m = last ? problem.goal_tolerance_m : 0.0;
    asked.time_limit_s = time.share_s(stops.size() - i);  // time left over by earlier legs is shared
    if (last) asked.goal_heading_rad = problem.goal_heading_rad;
    PosePlan leg = tolerance_m > 0.0 ? drivenWithin(asked, problem) : drivenTo(asked, problem, stops[i]);
    if (leg.status != RouteStatus::Found) return ended(std::move(leg));
    append(whole.drive, leg.path);
    const Segment ends{asked.start, stops[i]};
    const auto proven_J = [&] {
      const AddedTime proof(whole.proof_s);
      return bound_(problem.map, ends, tolerance_m, StopCheck(problem.watch, time.left_s()), leg.cost_J,
                    problem.gap);
    };
    const double bound_J = problem.prove ? proven_J() : 0.0;
    whole.lower_bound_J += std::min(bound_J, leg.cost_J);
    asked.start = stops[i];
    asked.start_heading_rad = endOf(leg.path).heading_rad;
    problem.watch.report(static_cast<double>(i + 1) / static_cast<double>(stops.size()));
  }
  for (const Pose& pose : chords(whole.drive, *problem.map))
    if (whole.points.empty() || !(whole.points.back() == pose.place)) whole.points.push_back(pose.place);
  const MotionCost motion(problem.map);
  whole.cost_J = PoseCost(motion, problem.kinematics)(whole.drive);
  return whole;
}

}  // namespace talus::planner
