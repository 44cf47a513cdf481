#pragma once

#include <string>
#include <utility>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// A plan without a route, and why.
inline Plan failedPlan(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

/// The same for work that was stopped.
inline Plan cancelledPlan(const StopCheck& stop) {
  if (stop.cancelled()) return failedPlan(RouteStatus::Cancelled, "cancelled before a route was found");
  return failedPlan(RouteStatus::TimedOut, "the time limit passed before a route was found; increase it");
}

}  // namespace talus::planner
