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

/// Values of the three objectives of a route.
struct RouteDemand {
  double energy_J = 0.0;  ///< energy of the route
  double time_s = 0.0;    ///< driving time of the route
  double risk = 0.0;      ///< probability of immobilisation on the route, [0, 1]
};

/// Returns the objectives of a plan on a map. The values are those of the annotated() route; therefore the
/// risk equals that of the route summary and of `talus score`.
RouteDemand demandOf(const costmap::CostGrid& map, const Plan& plan);

/// Returns the parameters of the risk simulation for a map, with the random seed `seed`. The correlation
/// length of `limit` is used only if the cost function of the map has none.
RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed);

/// Plans under a chance constraint: returns the cheapest route found for which demandOf().risk <= max_risk,
/// with max_risk in (0, 1). Routes that meet the constraint with a margin of two standard errors of
/// routeRisk() are preferred. The plan without the constraint is tried first. Then a price per unit of risk
/// is added to the cost. The price is raised until the constraint is met, and lowered as far as the
/// constraint permits (Lagrangian relaxation; routes that are not optimal for any price are missed
/// [everett_1963]). Without a time limit of the problem the search takes two seconds. If no route meets the
/// constraint, the status is NoneFound and the reason contains the lowest risk found. After a stop by
/// Problem::watch, the plan is marked `interrupted` or has the status Cancelled. Cost and lower bound of the
/// plan use the weights of the map. Throws std::invalid_argument if max_risk is out of range.
Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk);

/// Pareto-optimal route: no other candidate is at least as good in energy, time and risk and better in one.
struct ParetoRoute {
  Plan plan;                     ///< the route
  RouteDemand demand;            ///< values of the objectives
  costmap::CostWeights weights;  ///< weights of time and risk in the cost for which the route was planned
};

/// Returns the Pareto-optimal routes in energy, time and risk, in order of increasing energy. The candidates
/// are the routes that `planner` returns for `steps` x `steps` combinations of the weights of time and risk.
/// Returns an empty set if there is no route, or if Problem::watch was stopped, because the set of a part of
/// the combinations would differ. Throws std::invalid_argument if steps < 2.
std::vector<ParetoRoute> paretoSet(const Problem& problem, const std::function<Plan(const Problem&)>& planner,
                                   int steps);

}  // namespace talus::planner
