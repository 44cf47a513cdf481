#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans through the via points leg by leg. Each leg is the problem without via points from where the leg
/// before it ended to the next stop, which is met exactly but for the last, whose tolerance is the problem's.
/// Costs and lower bounds add up; the first leg that is not Found is the answer; its
/// reason calls a via point by its number, from 1. Progress goes to the
/// problem's watch.
Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg);

}  // namespace talus::planner
