#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// The cheapest of the plans to the problem's goals, each made by `plan` for one goal alone; Plan::goal is
/// which. Goals are tried nearest first, and those left out that cannot be cheaper even at the cheapest metre
/// of the map, so the answer is the best of the single plans. A goal that cannot be reached does not stand in
/// the way of the others; where none can, the status and reason are the nearest goal's. A time limit holds
/// for all goals together.
Plan planToCheapest(const Problem& problem, const std::function<Plan(const Problem& one_goal)>& plan);

}  // namespace talus::planner
