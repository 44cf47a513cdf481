// talus score DEM --path FILE: cost of a polyline under the planners' cost function.
#include <cmath>

#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::cli {
namespace {

struct ScoreOptions {
  GroundOptions ground;
  std::string path;
  std::string plugin, start, goal;  ///< alternative to `path`: the route of a plugin
  double time_limit_s = 0.0;        ///< time limit of the plugin; 0: no limit
  std::string chassis;
  bool prove = false;
};

std::string betterText(const Route& best, double cost_J) {
  if (!best.found()) return fmt::format("best route  {}\n", best.reason);
  return fmt::format("best route  {:.6g} J", best.cost) +
         (std::isfinite(cost_J) ? fmt::format(", {:.1f} % less\n", 100.0 * (1.0 - best.cost / cost_J))
                                : "\n");
}

std::string scoreText(const Score& s) {
  std::string text = fmt::format("cost        {:.6g} J (lower bound {:.6g} J)\n", s.cost, s.lower_bound) +
                     (std::isnan(s.time_s) ? ""
                                           : fmt::format("energy      {:.6g} J\ntime        {:.6g} s\n",
                                                         s.energy_J, s.time_s)) +
                     fmt::format("length      {:.6g} m\n", s.length_m) +
                     fmt::format("violations  {}\n", s.violations.size());
  std::string last;
  for (const auto& v : s.violations) {
    const std::string line = fmt::format("  {:.2f},{:.2f}: {}\n", v.place.x_m, v.place.y_m, v.reason);
    if (line != last) text += line;  // several pieces in one cell have the same place
    last = line;
  }
  return text;
}

void bind(CLI::App& command, ScoreOptions& options) {
  addGroundOptions(command, options.ground);
  addCostCurve(command, options.ground);
  addOption(command, "--path FILE", options.path);
  addOption(command, "--plugin FILE.so", options.plugin);
  addOption(command, "--start PLACE", options.start);
  addOption(command, "--goal PLACE", options.goal);
  addOption(command, "--time S", options.time_limit_s)->check(positive())->needs("--plugin");
  addChassisOption(command, options.chassis);
  command.add_flag("--prove", options.prove);
}

void requirePath(const ScoreOptions& options) {
  const bool routed = !options.plugin.empty() || !options.start.empty() || !options.goal.empty();
  if (routed &&
      (!options.path.empty() || options.plugin.empty() || options.start.empty() || options.goal.empty()))
    throw InputError({"talus score", "--plugin, --start and --goal belong together, in place of --path",
                      "pass all three, or --path alone"});
  if (!routed && options.path.empty()) throw InputError({"talus score", "no path", "pass --path FILE"});
}

// The polyline to score: read from a file, or planned by a plugin and returned even if the check refuses the
// route.
std::vector<maps::Point> pointsOf(const ScoreOptions& options, const Ground& ground, const Context& context) {
  if (options.plugin.empty()) return readPath(options.path, ground.map.elevation());
  planner::Problem problem;
  problem.map = ground.map.published();
  problem.start = maps::readPlace(options.start, ground.map.elevation(), "--start");
  problem.goal = maps::readPlace(options.goal, ground.map.elevation(), "--goal");
  problem.seed = context.seed;
  problem.threads = context.workers();
  problem.watch = context.watch("plan");
  if (options.time_limit_s > 0.0) problem.time_limit_s = options.time_limit_s;
  planner::Plan plan = planner::PluginPlanner(options.plugin).unchecked(problem);
  if (plan.status != planner::RouteStatus::Found && !context.stop.stop_requested())
    throw InputError({options.plugin, "found no route: " + plan.reason, "choose other places"});
  return std::move(plan.points);
}

int run(ScoreOptions& options, Context& context) {
  readMission(options.ground);
  requirePath(options);
  const Ground ground = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const auto points = pointsOf(options, ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  PlanRequest request{.prove = options.prove, .watch = context.watch(options.prove ? "prove" : "bound")};
  if (auto chassis = chassisOf(options.chassis, ground.map))
    request.chassis = std::make_shared<const planner::Chassis>(*std::move(chassis));
  const Score score = Planner({.threads = context.workers()}).score(ground.map, points, request);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  auto json = summaryJson(score);
  if (!score.found()) json["status"] = "infeasible";
  json["violations"] = jsonList(score.violations, [](const planner::Violation& v) -> nlohmann::ordered_json {
    return {{"x_m", v.place.x_m}, {"y_m", v.place.y_m}, {"reason", v.reason}};
  });
  if (score.best)
    json["best_cost"] = score.best->found() ? nlohmann::ordered_json(score.best->cost) : nullptr;
  json["seconds"] = {{"load", ground.load_s}, {"costmap", ground.build_s}};
  context.answer(json, scoreText(score) + (score.best ? betterText(*score.best, score.cost) : ""));
  return score.found() ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addScore(CLI::App& app, Context& context) {
  addCommand<ScoreOptions>(app, context, "score", bind, run);
}

}  // namespace talus::cli
