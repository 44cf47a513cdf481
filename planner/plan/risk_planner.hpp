#pragma once

#include <cstdint>

#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Returns the parameters of the risk simulation for a map, with the random seed `seed`. The correlation
/// length of `limit` is used only if the cost function of the map has none.
RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed);

/// Plans under a chance constraint: returns the cheapest route found whose risk in annotated() is at most
/// max_risk, with max_risk in (0, 1). Routes that meet the constraint with a margin of two standard errors of
/// routeRisk() are preferred. The plan without the constraint is tried first. Then a price per unit of risk
/// is added to the cost. The price is raised until the constraint is met, and lowered as far as the
/// constraint permits (Lagrangian relaxation; routes that are not optimal for any price are missed
/// [everett_1963]). Without a time limit of the problem the search takes two seconds. If no route meets the
/// constraint, the status is NoneFound and the reason contains the lowest risk found. After a stop by
/// Problem::watch, the plan is marked `interrupted` or has the status Cancelled. Cost and lower bound of the
/// plan use the weights of the map. Throws std::invalid_argument if max_risk is out of range.
Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk);

}  // namespace talus::planner
