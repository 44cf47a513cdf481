#pragma once

#include <string>
#include <utility>

#include <planner/problem.hpp>
#include <planner/stop_check.hpp>

namespace talus::planner {

/// A plan without a route, and why.
inline Plan ended(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

/// The same for work that was stopped.
inline Plan stoppedBy(const StopCheck& stop) {
  if (stop.cancelled()) return ended(RouteStatus::Cancelled, "cancelled before a route was found");
  return ended(RouteStatus::TimedOut, "the time limit passed before a route was found; allow more time");
}

}  // namespace talus::planner
