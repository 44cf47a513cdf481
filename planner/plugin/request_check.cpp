#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>
#include <talus/terramech/contact/turning_radius.hpp>

namespace talus::planner {
namespace {

[[noreturn]] void outOfRange(const std::string& field, double value, const std::string& bound) {
  std::ostringstream text;
  text << "PlanRequest: " << field << " = " << value << ", must be " << bound;
  throw std::invalid_argument(text.str());
}

void requireFinite(const std::string& field, const maps::Point& place) {
  if (!std::isfinite(place.x_m)) outOfRange(field + ".x_m", place.x_m, "finite");
  if (!std::isfinite(place.y_m)) outOfRange(field + ".y_m", place.y_m, "finite");
}

void requireRanges(const PlanRequest& request) {
  requireFinite("start", request.start);
  requireFinite("goal", request.goal);
  for (const maps::Point& goal : request.other_goals) requireFinite("other_goals", goal);
  for (const maps::Point& via : request.via) requireFinite("via", via);
  const auto finite = [](const char* field, const std::optional<double>& heading_rad) {
    if (heading_rad && !std::isfinite(*heading_rad)) outOfRange(field, *heading_rad, "finite");
  };
  finite("start_heading_rad", request.start_heading_rad);
  finite("goal_heading_rad", request.goal_heading_rad);
  if (!(request.gap >= 0 && request.gap < 1)) outOfRange("gap", request.gap, "at least 0 and below 1");
  if (!(request.tolerance_m >= 0)) outOfRange("tolerance_m", request.tolerance_m, ">= 0");
  if (request.kinematics && !terramech::isTurningRadius(request.kinematics->turning_radius_m))
    outOfRange("kinematics.turning_radius_m", request.kinematics->turning_radius_m, "0 or 0.001 to 1000");
  if (!request.risk_limit) return;
  const RiskLimit& risk = *request.risk_limit;
  if (!(risk.immobilisation > 0 && risk.immobilisation < 1))
    outOfRange("risk_limit.immobilisation", risk.immobilisation, "above 0 and below 1");
  if (!(risk.correlation_length_m > 0))
    outOfRange("risk_limit.correlation_length_m", risk.correlation_length_m, "> 0");
}

}  // namespace

void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers) {
  const auto refuse = [&offers](bool asked, bool honoured, const char* field) {
    if (asked && !honoured)
      throw std::invalid_argument(std::string("PlanRequest: ") + field + " is not honoured by planner '" +
                                  offers.planner + "' of " + offers.name +
                                  "; configure one that does, or leave it out");
  };
  refuse(!request.via.empty(), offers.via_points, "via");
  refuse(!request.other_goals.empty(), offers.several_goals, "other_goals");
  refuse(request.start_heading_rad.has_value(), offers.headings, "start_heading_rad");
  refuse(request.goal_heading_rad.has_value(), offers.headings, "goal_heading_rad");
  refuse(request.kinematics.has_value(), offers.turning_radius, "kinematics");
  refuse(request.kinematics && !request.kinematics->may_reverse, offers.reversing,
         "kinematics.may_reverse = false");
  refuse(request.chassis != nullptr, offers.chassis, "chassis");
  refuse(request.risk_limit.has_value(), offers.risk_limit, "risk_limit");
  requireRanges(request);
}

const PlannerSettings& validated(const PlannerSettings& settings) {
  if (settings.threads < 1)
    throw std::invalid_argument("PlannerSettings: threads = " + std::to_string(settings.threads) +
                                ", must be >= 1");
  if (!(settings.time_limit_s > 0))
    throw std::invalid_argument("PlannerSettings: time_limit_s = " + std::to_string(settings.time_limit_s) +
                                ", must be > 0");
  return settings;
}

}  // namespace talus::planner
