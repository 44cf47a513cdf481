#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route through the via points of `problem`, one leg (section between two stops) at a time, with
/// `plan_leg`. A stop is a via point or the goal. Each leg starts at the end of the previous leg and ends
/// exactly at the next stop; only the last leg uses the goal tolerance of the problem. Returns the joined
/// legs. The cost is the sum of the costs of the legs and of the turns at via points; the lower bound is the
/// sum of the lower bounds of the legs. If a leg is not Found, the function returns the plan of that leg; its
/// reason contains the number of the via point, from 1. Progress is reported to Problem::watch.
Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg);

}  // namespace talus::planner
