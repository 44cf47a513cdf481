#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plugin/own_planner.hpp>
#include <talus/planner/plugin/request_check.hpp>
#include <talus/planner/plugin/risk_planner.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {

const PlannerSettings& validated(const PlannerSettings& settings) {
  if (settings.threads < 1)
    throw std::invalid_argument("PlannerSettings: threads = " + std::to_string(settings.threads) +
                                ", must be >= 1");
  if (!(settings.time_limit_s > 0))
    throw std::invalid_argument("PlannerSettings: time_limit_s = " + std::to_string(settings.time_limit_s) +
                                ", must be > 0");
  return settings;
}

namespace {

RouteRiskOptions soilOf(const RiskLimit& limit, const costmap::CostGrid& map, std::uint64_t seed) {
  RouteRiskOptions options = riskOptions(map);
  if (!(map.cost().doubt().correlation_length_m > 0.0))
    options.correlation_length_m = limit.correlation_length_m;
  options.seed = seed;
  return options;
}

}  // namespace

PlannerCapabilities OwnPlanner::capabilities() const {
  const bool drives = planner_ && planner_->drives();
  return {.interface_version = kPlannerInterfaceVersion,
          .name = "talus",
          .version = TALUS_VERSION,
          .planners = plannerNames(),
          .planner = planner_ ? planner_->name() : plannerNames().front(),
          .heading_dependent = true,
          .lower_bound = true,
          .via_points = true,
          .several_goals = true,
          .headings = drives,
          .turning_radius = drives,
          .reversing = drives,
          .chassis = true,
          .risk_limit = true,
          .incremental_update = true,
          .deterministic = true};
}

void OwnPlanner::configure(const PlannerSettings& settings) {
  const std::string name = plannerName(validated(settings).planner);  // throws before anything is changed
  planner_.emplace(name);
  settings_ = settings;
}

void OwnPlanner::set_map(std::shared_ptr<const costmap::CostGrid> map) {
  if (!map) throw std::invalid_argument("set_map: no map");
  map_ = std::move(map);
}

void OwnPlanner::update(std::shared_ptr<const costmap::CostGrid> newer) {
  if (newer && map_ && !(newer->grid() == map_->grid()))
    throw std::invalid_argument("update: the newer map has another grid; use set_map");
  set_map(std::move(newer));
}

Problem OwnPlanner::problemOf(const PlanRequest& request) const {
  return {.map = map_,
          .start = request.start,
          .goal = request.goal,
          .other_goals = request.other_goals,
          .goal_tolerance_m = request.tolerance_m,
          .via = request.via,
          .time_limit_s = settings_.time_limit_s,
          .seed = settings_.seed,
          .threads = settings_.threads,
          .watch = request.watch,
          .start_heading_rad = request.start_heading_rad,
          .goal_heading_rad = request.goal_heading_rad,
          .kinematics = request.kinematics.value_or(Kinematics{})};
}

Route OwnPlanner::plan(const PlanRequest& request) {
  if (!map_) throw std::logic_error("plan: no map; call set_map first");
  if (!planner_) planner_.emplace();
  requireHonoured(request, capabilities());
  const Problem problem = problemOf(request);
  const auto once = [&](const Problem& asked) {
    if (!request.risk_limit) return planner_->plan(asked);
    return planWithinRisk(asked, *planner_, request.risk_limit->immobilisation,
                          soilOf(*request.risk_limit, *map_, settings_.seed));
  };
  const Plan plan =
      checkedPlan(request.chassis ? planOnChassis(problem, *request.chassis, once) : once(problem), *map_,
                  problem.kinematics.turning_radius_m);
  return annotated(
      plan,
      {.map = *map_, .elevation_m = nullptr, .planner = planner_->name(), .kinematics = problem.kinematics});
}

}  // namespace talus::planner
