#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/costmap/cost/cost_weights.hpp>
#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Objectives of a route: energy [J], time [s], probability of immobilisation [-].
struct RouteDemand {
  double energy_J = 0.0;
  double time_s = 0.0;
  double risk = 0.0;
};

/// Objectives of a plan on a map, from the route that annotated() returns for the plan. The risk therefore
/// equals that of the summary and of `talus score`.
RouteDemand demandOf(const costmap::CostGrid& map, const Plan& plan);

/// riskOptions() of a map for a limit and a seed. The correlation length of the limit is used if the map's
/// cost has none.
RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed);

/// Plans under a chance constraint: returns the cheapest route found whose probability of immobilisation,
/// according to demandOf(), is at most max_risk, in (0, 1); if possible with a margin of two standard errors
/// of routeRisk(). The plan without the constraint is tried first. Then the risk enters the cost with a
/// price, which is raised until the constraint is met and lowered as far as the constraint permits
/// (Lagrangian relaxation; routes that are optimal for no price are missed [everett_1963]). The search takes
/// two seconds if the problem has no time limit. Returns NoneFound with the least risk found if no route
/// meets the limit; after a stop by the problem's watch the plan is `interrupted` or Cancelled. Cost and
/// bound use the map's own weights. Throws std::invalid_argument if max_risk is out of range.
Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk);

/// A Pareto-optimal route.
struct ParetoRoute {
  Plan plan;
  RouteDemand demand;
  costmap::CostWeights weights;  ///< prices with which the route was planned
};

/// Pareto-optimal routes in energy, time and risk, in order of increasing energy. The candidates are the
/// routes of `planner` for `steps` x `steps` prices of time and risk. Empty if there is no route or if the
/// problem's watch was stopped, because a part of the prices gives a different set. Throws
/// std::invalid_argument if steps < 2.
std::vector<ParetoRoute> paretoSet(const Problem& problem, const std::function<Plan(const Problem&)>& planner,
                                   int steps);

}  // namespace talus::planner
