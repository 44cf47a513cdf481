#pragma once

#include <cmath>
#include <string>
#include <utility>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns a plan without a route, with the given status and reason.
inline Plan failedPlan(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

/// Returns the failed plan of a search that `stop` ended: status Cancelled or TimedOut.
inline Plan cancelledPlan(const StopCheck& stop) {
  if (stop.cancelled()) return failedPlan(RouteStatus::Cancelled, "cancelled before a route was found");
  return failedPlan(RouteStatus::TimedOut, "the time limit passed before a route was found; increase it");
}

/// Returns the plan unchanged, or a plan with status NoneFound if the cost of the plan is infinite. The cost
/// of a Found plan is infinite if the rover would tip during a turn between two legs.
inline Plan withoutTipping(Plan plan) {
  if (plan.status != RouteStatus::Found || std::isfinite(plan.cost_J)) return plan;
  return failedPlan(RouteStatus::NoneFound,
                    "no route found, nor a proof that there is none: on the one found, turns pass headings "
                    "in which the rover tips; "
                    "choose other places, or a rover with a lower centre of mass");
}

}  // namespace talus::planner
