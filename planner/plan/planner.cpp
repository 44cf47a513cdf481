#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/check/route_ends.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus {

using costmap::TraversabilityMap;

TraversabilityMap traversabilityMap(Site site, const ProgressMonitor& watch) {
  return {std::move(site.layers), std::make_shared<const costmap::GroundModel>(std::move(site.ground)),
          site.options, watch};
}

Map::Map(Site site, const ProgressMonitor& watch) : Map(traversabilityMap(std::move(site), watch)) {}
Map::Map(TraversabilityMap map)
    : map_(std::make_unique<TraversabilityMap>(std::move(map))),
      intake_(
          std::make_unique<costmap::DriveIntake>(*map_, nullptr, costmap::IntakeOptions{.settles = true})) {}
Map::Map(Map&&) noexcept = default;
Map& Map::operator=(Map&&) noexcept = default;
Map::~Map() = default;

Map Map::read(const std::string& path, int threads, const ProgressMonitor& watch) {
  return Map(costmap::readMap(path, threads, watch));
}

void Map::save(const std::string& path) const {
  costmap::writeMap(*map_, path);
}

LearnReport Map::learn(const Telemetry& drive) {
  return costmap::addDrive(*map_, drive);
}

std::size_t Map::learnPart(const Telemetry& part) {
  const std::size_t before = intake_->report().used;
  intake_->add(part);
  map_->publish();
  return intake_->report().used - before;
}

LearnReport Map::settle() {
  intake_->settle();
  map_->publish();
  return intake_->report();
}

void Map::patch(const costmap::SurfacePatch& seen) {
  map_->patch(seen);
}

void Map::move(maps::Cell tiles) {
  intake_->move(tiles);
}

costmap::Explanation Map::explain(maps::Point place, std::optional<double> heading_rad) const {
  const auto cell = map_->grid().cellAt(place);
  if (!cell) throw std::invalid_argument("explain: the place lies outside the map");
  if (!heading_rad) return costmap::explain(*map_, *cell);
  return costmap::explain(*map_, *cell, costmap::Direction{std::cos(*heading_rad), std::sin(*heading_rad)});
}

using planner::NamedPlanner;
using planner::Plan;
using planner::PluginPlanner;
using planner::Problem;

using Choice = std::variant<std::unique_ptr<NamedPlanner>, PluginPlanner>;

struct Planner::State {
  PlannerSettings settings;
  Choice planner;

  // Returns the planning problem of a request, without its chassis and risk limit.
  Problem problemOf(std::shared_ptr<const costmap::CostGrid> map, const PlanRequest& request) const {
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
            .watch = request.watch,
            .start_heading_rad = request.start_heading_rad,
            .goal_heading_rad = request.goal_heading_rad,
            .kinematics = request.kinematics.value_or(planner::Kinematics{})};
  }

  Plan search(const Problem& problem, const PlanRequest& request) {
    const auto once = [&](const Problem& asked) {
      if (const auto* plugin = std::get_if<PluginPlanner>(&planner)) return plugin->plan(asked);
      NamedPlanner& own = *std::get<0>(planner);
      if (!request.risk_limit) return own.plan(asked);
      return planner::planWithinRisk(asked, own, request.risk_limit->immobilisation);
    };
    return request.chassis ? planner::planOnChassis(problem, *request.chassis, once) : once(problem);
  }
};

namespace {

Choice planned(const std::string& name, const std::string& plugin) {
  if (plugin.empty()) return std::make_unique<NamedPlanner>(name);
  return PluginPlanner(plugin, name);
}

}  // namespace

Planner::Planner(const PlannerSettings& settings, const std::string& plugin)
    : state_(new State{planner::validated(settings), planned(settings.planner, plugin)}) {}
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;
Planner::~Planner() = default;

const std::string& Planner::name() const noexcept {
  const auto* plugin = std::get_if<PluginPlanner>(&state_->planner);
  return plugin ? plugin->name() : std::get<0>(state_->planner)->name();
}

PlannerCapabilities Planner::capabilities() const {
  const auto* own = std::get_if<0>(&state_->planner);
  const bool drives = !own || (*own)->drives();
  return {.name = "talus",
          .version = TALUS_VERSION,
          .planners = planner::plannerNames(),
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

Route Planner::plan(const Map& map, PlanRequest request) {
  request.hazards = [&at = map.ground()](maps::Cell cell) { return at.surface().hazards(cell); };
  return plan(map.ground().published(), request);
}

Route Planner::plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request) {
  if (!map) throw std::invalid_argument("plan: no map");
  planner::requireHonoured(request, capabilities());
  const Problem problem = state_->problemOf(map, request);
  return planner::checkedRoute(state_->search(problem, request), {.map = *map,
                                                                  .planner = name(),
                                                                  .kinematics = problem.kinematics,
                                                                  .hazards = problem.hazards,
                                                                  .watch = problem.watch});
}

Route Planner::plan(planner::WindowedMap& map, const PlanRequest& request) {
  if (name() != planner::plannerNames().front())
    throw std::invalid_argument("PlannerSettings: planner '" + name() + "' does not plan in windows; use '" +
                                planner::plannerNames().front() + "'");
  planner::requireHonoured(request, {.name = "talus, in windows", .planner = name(), .via_points = true});
  Problem problem = state_->problemOf(map.overview(), request);
  const Plan plan = planner::planInWindows(problem, map);  // sets problem.map
  return planner::checkedRoute(plan, {.map = *problem.map,
                                      .elevation_m = [&map](maps::Point p) { return map.elevation_m(p); },
                                      .planner = name(),
                                      .kinematics = problem.kinematics,
                                      .watch = request.watch});
}

Score Planner::score(const costmap::TraversabilityMap& map, const std::vector<maps::Point>& path,
                     PlanRequest request) {
  if (path.empty()) throw std::invalid_argument("score: the path has no point");
  const auto costs = map.published();
  std::vector<planner::Violation> all = planner::violations(*costs, path, request.watch);
  const auto add = [&all](const std::vector<planner::Violation>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(planner::violationsAtEnds(*costs, planner::endPoses(path),
                                [&map](maps::Cell cell) { return map.surface().hazards(cell); }));
  if (request.chassis) add(request.chassis->violations(path));
  Plan plan;
  plan.points = path;
  plan.status = all.empty() ? planner::RouteStatus::Found : planner::RouteStatus::NoRoute;
  if (all.empty()) plan.cost_J = planner::MotionCost(costs).along(path);
  request.start = path.front();
  request.goal = path.back();
  request.chassis = nullptr;
  std::optional<Route> best;
  if (request.prove) best = this->plan(costs, request);
  const double bound_J = best ? best->lower_bound
                              : planner::straightBoundOver_J(*costs, {request.start, request.goal}, 0.0,
                                                             plan.cost_J, request.watch);
  plan.lower_bound_J = std::min(plan.cost_J, bound_J);
  planner::AnnotationInput none{.map = *costs};
  none.planner = "none";
  none.watch = request.watch;
  Score score;
  static_cast<Route&>(score) = planner::annotated(plan, none);
  score.violations = std::move(all);
  score.best = std::move(best);
  return score;
}

}  // namespace talus
