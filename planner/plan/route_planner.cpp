#include <stdexcept>
#include <utility>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/plan/route_planner.hpp>
#include <talus/planner/plugin/request_check.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

RoutePlanner::RoutePlanner(const std::string& planner) : planner_(std::make_unique<NamedPlanner>(planner)) {}

const std::string& RoutePlanner::name() const noexcept {
  const auto* plugin = std::get_if<PluginPlanner>(&planner_);
  return plugin ? plugin->name() : (*std::get_if<0>(&planner_))->name();
}

PlannerCapabilities RoutePlanner::capabilities() const {
  const auto* own = std::get_if<0>(&planner_);
  const bool drives = !own || (*own)->drives();
  return {.name = "talus",
          .version = TALUS_VERSION,
          .planners = plannerNames(),
          .planner = name(),
          .heading_dependent = true,
          .lower_bound = true,
          .via_points = true,
          .several_goals = true,
          .headings = drives,
          .turning_radius = drives,
          .reversing = drives,
          .chassis = true,
          .risk_limit = own != nullptr,
          .incremental_update = true,
          .deterministic = true};
}

Problem problemOf(MapPointer map, const PlanRequest& request, const PlannerSettings& settings) {
  return {.map = std::move(map),
          .start = request.start,
          .goal = request.goal,
          .other_goals = request.other_goals,
          .goal_tolerance_m = request.tolerance_m,
          .via = request.via,
          .time_limit_s = settings.time_limit_s,
          .seed = settings.seed,
          .threads = settings.threads,
          .prove = request.prove,
          .gap = request.gap,
          .hazards = request.hazards,
          .whole_field = settings.whole_field,
          .watch = request.watch,
          .start_heading_rad = request.start_heading_rad,
          .goal_heading_rad = request.goal_heading_rad,
          .kinematics = request.kinematics.value_or(Kinematics{})};
}

Problem RoutePlanner::checkedProblem(const MapPointer& map, const PlanRequest& request,
                                     const PlannerSettings& settings) const {
  if (!map) throw std::invalid_argument("planRoute: no map");
  requireHonoured(request, capabilities());
  return problemOf(map, request, validated(settings));
}

Plan RoutePlanner::search(const Problem& problem, const PlanRequest& request) {
  const auto once = [&](const Problem& asked) {
    if (const auto* plugin = std::get_if<PluginPlanner>(&planner_)) return plugin->plan(asked);
    NamedPlanner& own = *std::get<0>(planner_);
    if (!request.risk_limit) return own.plan(asked);
    return planWithinRisk(asked, own, request.risk_limit->immobilisation);
  };
  return request.chassis ? planOnChassis(problem, *request.chassis, once) : once(problem);
}

Route RoutePlanner::plan(const MapPointer& map, const PlanRequest& request, const PlannerSettings& settings) {
  const Problem problem = checkedProblem(map, request, settings);
  return checkedRoute(search(problem, request), {.map = *map,
                                                 .planner = name(),
                                                 .kinematics = problem.kinematics,
                                                 .hazards = problem.hazards,
                                                 .watch = problem.watch});
}

PlannerCapabilities OwnPlanner::capabilities() const {
  return planner_ ? planner_->capabilities() : RoutePlanner().capabilities();
}

void OwnPlanner::configure(const PlannerSettings& settings) {
  RoutePlanner next(validated(settings).planner);  // may throw; nothing is changed before
  planner_.emplace(std::move(next));
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

Route OwnPlanner::plan(const PlanRequest& request) {
  if (!map_) throw std::logic_error("plan: no map; call set_map first");
  if (!planner_) planner_.emplace();
  return planner_->plan(map_, request, settings_);
}

}  // namespace talus::planner
