#pragma once

#include <cmath>
#include <string>
#include <utility>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// A plan without a route, with status and reason.
inline Plan failedPlan(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

/// The failed plan for a stopped search: Cancelled or TimedOut.
inline Plan cancelledPlan(const StopCheck& stop) {
  if (stop.cancelled()) return failedPlan(RouteStatus::Cancelled, "cancelled before a route was found");
  return failedPlan(RouteStatus::TimedOut, "the time limit passed before a route was found; increase it");
}

/// Returns the plan, or NoneFound if its cost is infinite because a turn between legs tips the rover.
inline Plan withoutTipping(Plan plan) {
  if (plan.status != RouteStatus::Found || std::isfinite(plan.cost_J)) return plan;
  return failedPlan(RouteStatus::NoneFound,
                    "no route found, nor a proof that there is none: on the one found, turns pass headings "
                    "in which the rover tips; "
                    "choose other places, or a rover with a lower centre of mass");
}

}  // namespace talus::planner
