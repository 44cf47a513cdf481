#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans through the via points leg by leg. Each leg starts at the end of the previous leg and ends at the
/// next stop, without tolerance except for the last leg, which uses the problem's tolerance. Costs and lower
/// bounds are summed. The first leg that is not Found is returned; its reason names the via point by its
/// index, from 1. Progress is reported to the problem's watch.
Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg);

}  // namespace talus::planner
