#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Returns the cheapest of the plans to the goals of `problem`. `plan` plans to a single goal; Plan::goal of
/// the result is the index of the selected goal. Goals are tried in the order of their straight-line lower
/// bounds. A goal is skipped if its lower bound is not below the best cost; therefore the result equals the
/// best of the plans to all goals. A goal that cannot be reached does not prevent plans to the other goals.
/// If no goal can be reached, status and reason are those of the first goal tried. The time limit applies to
/// all goals together.
Plan planToCheapest(const Problem& problem, const std::function<Plan(const Problem& one_goal)>& plan);

}  // namespace talus::planner
