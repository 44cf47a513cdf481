#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/polyline.hpp>

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

namespace {

// Range of the prices of losing the rover [J]: from negligible to beyond any battery.
constexpr double kLeastPrice_J = 1e3;
constexpr double kHighestPrice_J = 1e13;
constexpr int kHalvings = 8;
constexpr double kTime_s = 2.0;  // for all prices without a time limit

Plan planUnder(const Problem& problem, NamedPlanner& planner, const costmap::CostWeights& weights) {
  Problem weighed = problem;
  weighed.map = costmap::reweighted(*problem.map, weights);
  Plan plan = planner.plan(weighed);
  if (plan.status == RouteStatus::Found) plan.cost_J = MotionCost(problem.map).along(plan.points);
  return plan;
}

std::string inWords(double probability, int digits = 3) {
  std::ostringstream text;
  text.precision(digits);
  text << probability;
  return text.str();
}

double riskOf(const Route& route) {
  return route.vertices.empty() ? 0.0 : route.vertices.back().immobilisation_risk;
}

// Stores the cheapest plan within the limit, and the least risk found.
class RiskBoundedSearch {
 public:
  RiskBoundedSearch(const Problem& problem, NamedPlanner& planner, double max_risk)
      : problem_(problem), planner_(planner), max_risk_(max_risk) {}

  // Returns true if the plan meets the limit, also in a second simulation with more worlds; nothing if no
  // route was found.
  std::optional<bool> taken(const Plan& plan) {
    proof_s_ += plan.proof_s;
    if (plan.status != RouteStatus::Found) return std::nullopt;
    AnnotationInput input{.map = *problem_.map};
    input.watch = problem_.watch;
    const Route route = annotated(plan, input);
    const double risk = riskOf(route);
    least_risk_ = std::min(least_risk_, risk);
    if (risk > max_risk_) return false;
    const bool surely = surelyKeeps(route);
    std::optional<Plan>& best = surely ? best_ : uncertain_;
    if (!best || plan.cost_J < best->cost_J) best = plan;
    return surely;
  }

  // Returns true if a route under a price of risk meets the limit: the field route and, if requested, the
  // best route of all corridors. Uses the remaining time; the first route is always planned.
  bool tried(double price_J) {
    bool kept = false;
    for (const bool prove : {false, true}) {
      const double left_s = leftSeconds();
      if ((prove && !problem_.prove) || (any_ && !(left_s > 0.0)) || problem_.watch.stopped()) break;
      Problem asked = problem_;
      asked.prove = prove;
      asked.time_limit_s = any_ ? left_s : std::max(left_s, problem_.time_limit_s);
      any_ = true;
      kept = taken(planUnder(asked, planner_, {.energy = 1.0, .time_W = 1.0, .risk_J = price_J}))
                 .value_or(false) ||
             kept;
    }
    return kept;
  }
  bool late() const { return problem_.watch.stopped() || !(leftSeconds() > 0.0); }

  // After a stop too few prices were tried for the result that no route meets the limit.
  Plan result(double lower_bound_J) const {
    const bool stopped = problem_.watch.stopped();
    if (best_ || uncertain_) {
      Plan plan = best_ ? *best_ : *uncertain_;
      plan.lower_bound_J = std::min(lower_bound_J, plan.cost_J);
      plan.proof_s = proof_s_;
      plan.interrupted |= stopped;
      return plan;
    }
    Plan none;
    if (stopped) {
      none.status = RouteStatus::Cancelled;
      none.reason = "planning was cancelled before a route within the risk limit was found";
      return none;
    }
    int digits = 3;
    while (digits < 17 && inWords(max_risk_, digits) == inWords(least_risk_, digits)) ++digits;
    none.reason = "no route found that keeps the risk of immobilisation within " +
                  inWords(max_risk_, digits) + ": the safest route found has " +
                  inWords(least_risk_, digits) +
                  ", which proves nothing of others; increase the limit or choose another goal";
    return none;
  }

 private:
  // Requires a margin of two standard errors, so that the cheapest of many routes is not selected for a low
  // random estimate.
  bool surelyKeeps(const Route& route) const {
    if (!(problem_.map->cost().uncertainty().correlation_length_m > 0.0)) return true;  // no simulation
    const RouteRisk drawn = routeRisk(route, riskOptions(*problem_.map), problem_.watch);
    return drawn.immobilisation + 2.0 * drawn.standard_error <= max_risk_;
  }

  // Remaining time of the time limit, or of kTime_s without a limit.
  double leftSeconds() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
    return (std::isfinite(problem_.time_limit_s) ? problem_.time_limit_s : kTime_s) - spent.count();
  }

  const Problem& problem_;
  NamedPlanner& planner_;
  double max_risk_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  bool any_ = false;
  double least_risk_ = 1.0, proof_s_ = 0.0;
  std::optional<Plan> best_;
  std::optional<Plan> uncertain_;  // within the limit by the first estimate only
};

}  // namespace

RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed) {
  RouteRiskOptions options = riskOptions(map);
  if (!(map.cost().uncertainty().correlation_length_m > 0.0))
    options.correlation_length_m = limit.correlation_length_m;
  options.seed = seed;
  return options;
}

Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk) {
  if (!(max_risk > 0 && max_risk < 1))
    throw std::invalid_argument("risk: " + inWords(max_risk) + ", must be above 0 and below 1");
  const Plan own = planner.plan(problem);
  if (own.status != RouteStatus::Found) return own;
  RiskBoundedSearch search(problem, planner, max_risk);
  if (*search.taken(own)) return search.result(own.lower_bound_J);
  // Bisects log10 of the price between the lowest price that meets the limit and the highest that does not.
  // If the highest price fails, a lower price may succeed: the price weights all metres equally, but failures
  // of neighbouring metres are correlated in the risk.
  double enough = std::log10(kHighestPrice_J);
  double too_low = std::log10(kLeastPrice_J);
  search.tried(kHighestPrice_J);
  for (int i = 0; i < kHalvings && !search.late(); ++i) {
    const double middle = (enough + too_low) / 2;
    (search.tried(std::pow(10.0, middle)) ? enough : too_low) = middle;
    problem.watch.report((i + 1.0) / kHalvings);
  }
  return search.result(own.lower_bound_J);
}

}  // namespace talus::planner
