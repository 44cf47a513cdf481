#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plan/risk_planner.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {
namespace {

// Prices of the rover's loss in joules that are tried: from next to nothing to beyond any battery.
constexpr double kLeastPrice_J = 1e3;
constexpr double kHighestPrice_J = 1e13;
constexpr int kHalvings = 8;

Plan planUnder(const Problem& problem, const std::function<Plan(const Problem&)>& planner,
               const costmap::CostWeights& weights) {
  Problem weighed = problem;
  weighed.map = costmap::reweighted(*problem.map, weights);
  Plan plan = planner(weighed);
  if (plan.status == RouteStatus::Found) plan.cost_J = MotionCost(problem.map).along(plan.points);
  return plan;
}

std::string inWords(double probability) {
  std::ostringstream text;
  text.precision(3);
  text << probability;
  return text.str();
}

// 1 where `watch` was stopped before it was known.
double riskOf(const costmap::CostGrid& map, const Plan& plan, const RouteRiskOptions& soil,
              const ProgressMonitor& watch) {
  const Route route = annotated(plan, {.map = map, .planner = {}});
  if (route.vertices.empty()) return 0.0;
  const RouteRisk drawn = routeRisk(route, soil, watch);
  if (std::isnan(drawn.immobilisation)) return 1.0;
  return drawn.immobilisation + 2.0 * drawn.standard_error;
}

// Keeps the cheapest of the plans within the limit, and the least risk of all.
class RiskBoundedSearch {
 public:
  RiskBoundedSearch(const Problem& problem, NamedPlanner& planner, double max_risk,
                    const RouteRiskOptions& soil)
      : problem_(problem), planner_(planner), max_risk_(max_risk), soil_(soil) {}

  // Whether the price brings the risk within the limit; nothing when planning did not find a route.
  std::optional<bool> tried(double price_J) {
    const auto plan = [this](const Problem& problem) { return planner_.plan(problem); };
    return taken(planUnder(problem_, plan, {.energy = 1.0, .time_W = 1.0, .risk_J = price_J}));
  }

  std::optional<bool> taken(Plan plan) {
    if (plan.status != RouteStatus::Found) {
      failure_ = std::move(plan);
      return std::nullopt;
    }
    const double risk = riskOf(*problem_.map, plan, soil_, problem_.watch);
    least_risk_ = std::min(least_risk_, risk);
    if (risk > max_risk_) return false;
    if (!best_ || plan.cost_J < best_->cost_J) best_ = std::move(plan);
    return true;
  }

  // A search that a stop cut short has tried too few prices to say that none does.
  Plan result(double lower_bound_J) const {
    const bool stopped = problem_.watch.stopped();
    if (best_) {
      Plan plan = *best_;
      plan.lower_bound_J = std::min(lower_bound_J, plan.cost_J);
      plan.interrupted |= stopped;
      return plan;
    }
    if (failure_) return *failure_;
    Plan none;
    if (stopped) {
      none.status = RouteStatus::Cancelled;
      none.reason = "planning was cancelled before a route within the risk limit was found";
      return none;
    }
    none.reason = "no route found that keeps the risk of immobilisation within " + inWords(max_risk_) +
                  ": the safest route found has " + inWords(least_risk_) +
                  ", which proves nothing of others; increase the limit or choose another goal";
    return none;
  }

 private:
  const Problem& problem_;
  NamedPlanner& planner_;
  double max_risk_;
  RouteRiskOptions soil_;
  double least_risk_ = 1.0;
  std::optional<Plan> best_;
  std::optional<Plan> failure_;
};

bool dominates(const RouteDemand& a, const RouteDemand& b) {
  return a.energy_J <= b.energy_J && a.time_s <= b.time_s && a.risk <= b.risk &&
         (a.energy_J < b.energy_J || a.time_s < b.time_s || a.risk < b.risk);
}

bool same(const RouteDemand& a, const RouteDemand& b) {
  return a.energy_J == b.energy_J && a.time_s == b.time_s && a.risk == b.risk;
}

void keep(std::vector<ParetoRoute>& front, ParetoRoute route) {
  for (const ParetoRoute& other : front)
    if (dominates(other.demand, route.demand) || same(other.demand, route.demand)) return;
  std::erase_if(front, [&](const ParetoRoute& other) { return dominates(route.demand, other.demand); });
  front.push_back(std::move(route));
}

}  // namespace

RouteDemand demandOf(const costmap::CostGrid& map, const Plan& plan) {
  const Route route = annotated(plan, {.map = map, .planner = {}});
  return {.energy_J = route.summary.energy_J,
          .time_s = route.summary.time_s,
          .risk = route.vertices.empty() ? 0.0 : route.vertices.back().immobilisation_risk};
}

RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed) {
  RouteRiskOptions options = riskOptions(map);
  if (!(map.cost().doubt().correlation_length_m > 0.0))
    options.correlation_length_m = limit.correlation_length_m;
  options.seed = seed;
  return options;
}

Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk,
                    const RouteRiskOptions& soil) {
  if (!(max_risk > 0 && max_risk < 1))
    throw std::invalid_argument("risk: " + inWords(max_risk) + ", must be above 0 and below 1");
  RiskBoundedSearch search(problem, planner, max_risk, soil);
  const Plan own = planner.plan(problem);
  if (search.taken(own).value_or(true)) return search.result(own.lower_bound_J);
  // The lowest price that is known to do and the highest that is known not to, in powers of ten.
  double enough = std::log10(kHighestPrice_J);
  double too_low = std::log10(kLeastPrice_J);
  if (!search.tried(kHighestPrice_J).value_or(false)) return search.result(own.lower_bound_J);
  for (int i = 0; i < kHalvings && !problem.watch.stopped(); ++i) {
    const double middle = (enough + too_low) / 2;
    const auto kept = search.tried(std::pow(10.0, middle));
    if (!kept) break;
    (*kept ? enough : too_low) = middle;
    problem.watch.report((i + 1.0) / kHalvings);
  }
  return search.result(own.lower_bound_J);
}

std::vector<ParetoRoute> paretoSet(const Problem& problem, const std::function<Plan(const Problem&)>& planner,
                                   int steps) {
  if (steps < 2)
    throw std::invalid_argument("paretoSet: steps = " + std::to_string(steps) + ", must be >= 2");
  const auto price = [steps](int i, double low, double high) {
    return i == 0 ? 0.0 : low * std::pow(high / low, (i - 1.0) / std::max(1, steps - 2));
  };
  std::vector<ParetoRoute> front;
  for (int t = 0; t < steps; ++t)
    for (int r = 0; r < steps; ++r) {
      const costmap::CostWeights weights{
          .energy = 1.0, .time_W = price(t, 1.0, 1e4), .risk_J = price(r, 1e2, 1e10)};
      Plan plan = planUnder(problem, planner, weights);
      if (problem.watch.stopped()) return {};
      if (plan.status != RouteStatus::Found && plan.status != RouteStatus::TimedOut &&
          plan.status != RouteStatus::NoneFound)
        return {};
      if (plan.status != RouteStatus::Found) continue;  // the time limit of this one, or nothing sampled
      const RouteDemand demand = demandOf(*problem.map, plan);
      keep(front, {.plan = std::move(plan), .demand = demand, .weights = weights});
      problem.watch.report((t * steps + r + 1.0) / (steps * steps));
    }
  std::ranges::sort(front, {}, [](const ParetoRoute& route) { return route.demand.energy_J; });
  return front;
}

}  // namespace talus::planner
