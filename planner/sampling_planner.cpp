#include <chrono>
#include <cmath>
#include <stdexcept>

#include <planner/ompl_run.hpp>
#include <planner/planner_names.hpp>
#include <planner/remedy.hpp>
#include <planner/sampling_planner.hpp>

namespace talus::planner {
namespace {

SamplingSettings validated(SamplingSettings settings) {
  settings.planner = plannerName(settings.planner);
  if (settings.planner == "field") throw std::invalid_argument("planner 'field' does not sample");
  if (settings.work == 0) throw std::invalid_argument("sampling: work = 0, must be > 0");
  if (!(settings.range_cells > 0))
    throw std::invalid_argument("sampling: range_cells = " + std::to_string(settings.range_cells) +
                                ", must be > 0");
  return settings;
}

std::vector<Problem> legsOf(const Problem& problem) {
  std::vector<Problem> legs;
  maps::Point from = problem.start;
  for (std::size_t i = 0; i <= problem.via.size(); ++i) {
    Problem leg = problem;
    leg.via.clear();
    leg.start = from;
    const bool last = i == problem.via.size();
    leg.goal = last ? problem.goal : problem.via[i];
    leg.goal_tolerance_m = last ? problem.goal_tolerance_m : 0.0;
    leg.time_limit_s = problem.time_limit_s / static_cast<double>(problem.via.size() + 1);
    from = leg.goal;
    legs.push_back(std::move(leg));
  }
  return legs;
}

Plan ended(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

Plan checkEnds(const Problem& leg) {
  const MotionCost cost(leg.map);
  if (!cost.allowed(leg.start))
    return ended(RouteStatus::StartInvalid, invalidPlace(*leg.map, "start", leg.start));
  if (!cost.allowed(leg.goal) && !(leg.goal_tolerance_m > 0))
    return ended(RouteStatus::GoalInvalid, invalidPlace(*leg.map, "goal", leg.goal));
  return ended(RouteStatus::Found, {});
}

Plan arrived(const Problem& leg) {
  Plan plan = ended(RouteStatus::Found, {});
  plan.points = {leg.start};
  plan.cost_J = 0.0;
  return plan;
}

Plan planLeg(const Problem& leg, const SamplingSettings& settings, const LegScout& scout) {
  if (Plan ends = checkEnds(leg); ends.status != RouteStatus::Found) return ends;
  const double apart_m = std::hypot(leg.goal.x_m - leg.start.x_m, leg.goal.y_m - leg.start.y_m);
  if (apart_m <= leg.goal_tolerance_m) return arrived(leg);
  const LegKnowledge known = scout ? scout(leg) : LegKnowledge{};
  if (known.plan.status == RouteStatus::Cancelled) return known.plan;
  if (settings.better && known.plan.status == RouteStatus::Found) settings.better(known.plan.cost_J);
  Plan found = runOmpl(leg, settings, known);
  const bool known_better = known.plan.status == RouteStatus::Found && known.plan.cost_J <= found.cost_J;
  if (known_better && found.status != RouteStatus::Cancelled) return known.plan;
  return found;
}

void append(Plan& whole, const Plan& leg) {
  whole.points.insert(whole.points.end(), leg.points.begin() + (whole.points.empty() ? 0 : 1),
                      leg.points.end());
  whole.cost_J += leg.cost_J;
  whole.lower_bound_J += leg.lower_bound_J;
}

}  // namespace

Plan planBySampling(const Problem& problem, const SamplingSettings& settings, const LegScout& scout) {
  const SamplingSettings checked = validated(settings);
  Plan whole;
  whole.status = RouteStatus::Found;
  whole.cost_J = 0.0;
  const std::vector<Problem> legs = legsOf(problem);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Plan leg = planLeg(legs[i], checked, scout);
    if (leg.status != RouteStatus::Found) return leg;
    append(whole, leg);
    problem.watch.report(static_cast<double>(i + 1) / static_cast<double>(legs.size()));
  }
  return whole;
}

}  // namespace talus::planner
