#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Returns the cheapest of the plans to the problem's goals. `plan` plans to a single goal; Plan::goal is the
/// index of the chosen goal. Goals are tried in the order of their straight-line lower bounds, and a goal
/// whose bound is not below the best cost is skipped, so the result equals the best of all single plans. An
/// unreachable goal does not prevent plans to the others. If no goal is reachable, status and reason are
/// those of the first goal tried. The time limit applies to all goals together.
Plan planToCheapest(const Problem& problem, const std::function<Plan(const Problem& one_goal)>& plan);

}  // namespace talus::planner
