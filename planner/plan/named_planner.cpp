#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {
namespace {

// One of the goals: its index, its place, and a lower bound of the cost of any route to the goal.
struct Candidate {
  std::size_t goal;
  maps::Point place;
  double bound_J;
};

double straightThrough_J(const Problem& problem, maps::Point goal) {
  double sum_J = 0.0;
  maps::Point at = problem.start;
  for (const maps::Point via : problem.via) {
    sum_J += straightBound_J(*problem.map, {at, via});
    at = via;
  }
  return sum_J + straightBound_J(*problem.map, {at, goal}, problem.goal_tolerance_m);
}

std::vector<Candidate> nearestFirst(const Problem& problem) {
  std::vector<Candidate> goals{{0, problem.goal, straightThrough_J(problem, problem.goal)}};
  for (const maps::Point place : problem.other_goals)
    goals.push_back({goals.size(), place, straightThrough_J(problem, place)});
  std::ranges::stable_sort(goals, {}, &Candidate::bound_J);
  return goals;
}

Problem towards(const Candidate& goal, const Problem& problem, double time_limit_s) {
  Problem one = problem;
  one.goal = goal.place;
  one.other_goals.clear();
  one.time_limit_s = time_limit_s;
  return one;
}

bool endsAll(RouteStatus status) {
  return status == RouteStatus::Cancelled || status == RouteStatus::StartInvalid;
}

}  // namespace

Plan planToCheapest(const Problem& problem, const std::function<Plan(const Problem& one_goal)>& plan) {
  if (!problem.map) throw std::invalid_argument("planToCheapest: no map");
  const auto begin = std::chrono::steady_clock::now();
  Plan best;
  double bound_J = std::numeric_limits<double>::infinity();
  double proof_s = 0.0;
  bool first = true, proven = true;
  for (const Candidate& goal : nearestFirst(problem)) {
    if (goal.bound_J >= best.cost_J) break;
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double left_s = problem.time_limit_s - spent_s;
    if (!first && !(left_s > 0.0)) {
      proven = false;
      bound_J = std::min(bound_J, goal.bound_J);
      break;
    }
    Plan one = plan(towards(goal, problem, left_s > 0.0 ? left_s : problem.time_limit_s));
    if (endsAll(one.status)) return one;
    one.goal = goal.goal;
    proof_s += one.proof_s;
    const bool found = one.status == RouteStatus::Found;
    proven = proven && (one.status == RouteStatus::NoRoute || one.status == RouteStatus::GoalInvalid);
    if (one.status != RouteStatus::GoalInvalid)
      bound_J = std::min(bound_J, found ? one.lower_bound_J : goal.bound_J);
    if (first || (found && one.cost_J < best.cost_J)) best = std::move(one);
    first = false;
  }
  if (best.status == RouteStatus::NoRoute && !proven) best.status = RouteStatus::NoneFound;
  if (best.status == RouteStatus::Found) best.lower_bound_J = std::min(bound_J, best.cost_J);
  best.proof_s = proof_s;
  return best;
}

NamedPlanner::NamedPlanner(const std::string& name) {
  settings_ = samplingSettings(name);
}

Plan NamedPlanner::plan(const Problem& problem) {
  Plan plan = problem.other_goals.empty()
                  ? planOne(problem)
                  : planToCheapest(problem, [this](const Problem& one_goal) { return planOne(one_goal); });
  plan.interrupted = problem.watch.stopped();
  return plan;
}

Plan NamedPlanner::planOne(const Problem& problem) {
  if (settings_.planner == plannerNames().front()) return field_.plan(problem);
  if (drives()) return drive_.plan(problem);
  const auto field = [this](const Problem& leg) { return field_.plan(leg); };
  return planBySampling(problem, settings_, settings_.cold ? InitialPathProvider() : field);
}

}  // namespace talus::planner
