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

/// The objectives of a route. Energy in joules, time in seconds, risk = probability of
/// immobilisation.
struct RouteDemand {
  double energy_J = 0.0;
  double time_s = 0.0;
  double risk = 0.0;
};

/// The demand of a plan on a map, integrated along it: of the route that annotated() makes of it, so that its risk is
/// what a summary and `score` tell.
RouteDemand demandOf(const costmap::CostGrid& map, const Plan& plan);

/// riskOptions() of a map for a limit and a seed: the limit's correlation length counts where the map's cost states
/// none.
RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed);

/// Plans under a chance constraint: the cheapest route found whose probability of immobilisation, as demandOf() has
/// it, is at most max_risk, in (0, 1); where it can be had, by two standard errors of routeRisk(), too. The plan
/// without the constraint is the first that is tried; then the constraint enters the cost as a price on risk, raised
/// until it is met and lowered as far as it still is (Lagrangian relaxation; a route that no price picks out is
/// missed [everett_1963]), for two seconds where the problem sets no time limit. NoneFound with the least risk found
/// when none keeps the limit; where the problem's watch was stopped before, `interrupted` or Cancelled. Cost and
/// bound are of the map's own weights. Throws std::invalid_argument out of range.
Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk);

/// One way to trade energy, time and risk.
struct ParetoRoute {
  Plan plan;
  RouteDemand demand;
  costmap::CostWeights weights;  ///< that picked it
};

/// Routes of which none is better than another in energy, time and risk together, by rising energy: those
/// that some prices of time and risk pick out for `planner`, among `steps` by `steps` prices. Empty when there is no
/// route, and when the problem's watch was stopped: a part of the prices makes another set.
std::vector<ParetoRoute> paretoSet(const Problem& problem, const std::function<Plan(const Problem&)>& planner,
                                   int steps);

}  // namespace talus::planner
