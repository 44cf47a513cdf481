#include <string>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {
namespace {

// Replaces "start" and "goal" in the reason of a failed leg by the number of the via point.
std::string ofTheWhole(std::string reason, std::size_t leg, std::size_t legs) {
  const auto rename = [&reason](const std::string& end, std::size_t via) {
    if (reason.starts_with(end + ' ')) reason.replace(0, end.size(), "via point " + std::to_string(via));
  };
  if (leg > 0) rename("start", leg);
  if (leg + 1 < legs) rename("goal", leg + 1);
  return reason;
}

// Returns the cost [J] of the turn from the last leg of `a` to the first leg of `b`, at a via point.
double turnBetween(const Problem& problem, const Polyline& a, const Polyline& b) {
  if (!problem.map || a.size() < 2 || b.size() < 2) return 0.0;
  return MotionCost(problem.map)
      .turn(b.front(), directionOf({a[a.size() - 2], a.back()}), directionOf({b[0], b[1]}));
}

}  // namespace

Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg) {
  std::vector<maps::Point> stops = problem.via;
  stops.push_back(problem.goal);
  Plan whole{RouteStatus::Found, {}, {problem.start}, 0.0, 0.0};
  Problem leg = problem;
  leg.via.clear();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    leg.start = whole.points.back();
    leg.goal = stops[i];
    leg.goal_tolerance_m = i + 1 == stops.size() ? problem.goal_tolerance_m : 0.0;
    Plan part = plan_leg(leg);
    if (part.status != RouteStatus::Found) {
      part.reason = ofTheWhole(std::move(part.reason), i, stops.size());
      return part;
    }
    whole.cost_J += part.cost_J + turnBetween(problem, whole.points, part.points);
    append(whole.points, part.points);
    whole.lower_bound_J += part.lower_bound_J;
    whole.proof_s += part.proof_s;
    problem.watch.report(static_cast<double>(i + 1) / static_cast<double>(stops.size()));
  }
  return whole;
}

}  // namespace talus::planner
