#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route through the via points of `problem`, leg by leg, with `plan_leg`. A leg starts at the end of
/// the previous leg and ends exactly at the next via point or the goal; only the last leg uses the goal
/// tolerance. The cost is the sum of the costs of the legs and of the turns at via points; the lower bound is
/// the sum of the lower bounds of the legs. If a leg is not Found, its plan is returned, with the number of
/// the via point, from 1, in the reason. Progress is reported to Problem::watch.
Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg);

}  // namespace talus::planner
