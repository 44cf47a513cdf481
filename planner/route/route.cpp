#include <talus/planner/route/route.hpp>

namespace talus::planner {

std::string_view name(RouteStatus status) noexcept {
  switch (status) {
    case RouteStatus::Found:
      return "found";
    case RouteStatus::NoRoute:
      return "no_route";
    case RouteStatus::NoneFound:
      return "none_found";
    case RouteStatus::StartInvalid:
      return "start_invalid";
    case RouteStatus::GoalInvalid:
      return "goal_invalid";
    case RouteStatus::TimedOut:
      return "timed_out";
    case RouteStatus::Cancelled:
      return "cancelled";
  }
  return "unknown";
}

const char* name(Constraint constraint) noexcept {
  switch (constraint) {
    case Constraint::Pitch:
      return "pitch";
    case Constraint::Roll:
      return "roll";
    case Constraint::Soil:
      return "soil";
    case Constraint::Hazard:
      return "hazard";
    case Constraint::Unknown:
      return "unknown";
    case Constraint::Rim:
      return "rim";
    case Constraint::Slope:
      return "slope";
  }
  return "";
}

const char* name(costmap::Hazard hazard) noexcept {
  using costmap::Hazard;
  if (hazard == Hazard::KeepOut) return "keep_out";
  if (hazard == Hazard::Obstacle) return "impassable_class";
  if (hazard == Hazard::Rocks) return "rocks";
  if (hazard == Hazard::Step) return "step";
  return hazard == Hazard::Roughness ? "roughness" : "";
}

}  // namespace talus::planner
