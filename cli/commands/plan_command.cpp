// talus plan DEM --start P --goal P: a route.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/pareto_chart.hpp>
#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/reach_scene.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/drive_options.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/ground/plan_options.hpp>
#include <talus/cli/ground/plugin_option.hpp>
#include <talus/cli/ground/windowed_ground.hpp>
#include <talus/cli/route/plan_pairs.hpp>
#include <talus/cli/route/route_json.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/raster/place_reader.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/plugin/named_planner.hpp>
#include <talus/planner/plugin/risk_planner.hpp>

namespace talus::cli {
namespace {

using planner::Route;
using planner::RouteStatus;

// Prices of time and of risk that are tried for the Pareto set, each.
constexpr int kParetoSteps = 6;

struct Timing {
  double load_s, costmap_s, plan_s;
};

planner::Problem problemOf(const PlanOptions& options, const Ground& ground, const Context& context) {
  const maps::ElevationMap& map = ground.map.elevation();
  planner::Problem problem;
  problem.map = ground.map.published();
  if (options.pairs.empty()) {
    problem.start = maps::readPlace(options.start, map, "--start");
    problem.goal = maps::readPlace(options.goals.front(), map, "--goal");
    for (auto goal = options.goals.begin() + 1; goal != options.goals.end(); ++goal)
      problem.other_goals.push_back(maps::readPlace(*goal, map, "--goal"));
  }
  for (const std::string& place : options.via) problem.via.push_back(maps::readPlace(place, map, "--via"));
  problem.goal_tolerance_m = options.tolerance_m;
  if (options.time_limit_s > 0.0) problem.time_limit_s = options.time_limit_s;
  problem.seed = context.seed;
  problem.threads = context.workers();
  problem.start_heading_rad = options.drive.start_heading_rad;
  problem.goal_heading_rad = options.drive.goal_heading_rad;
  problem.kinematics = kinematicsOf(options.drive, ground.map);
  problem.whole_field = options.whole_field;
  problem.watch = context.watch("plan");
  if (options.plugin.empty()) context.answerStop();  // a plugin's route is whole or none
  return problem;
}

// A planner of the program's own, or one of --plugin.
struct Chosen {
  std::unique_ptr<planner::NamedPlanner> own;
  std::optional<planner::PluginPlanner> plugin;

  const std::string& name() const { return plugin ? plugin->name() : own->name(); }
};

Chosen choose(const PlanOptions& options) {
  Chosen chosen{.own = {}, .plugin = {}};
  if (!options.plugin.empty()) {
    chosen.plugin.emplace(pluginOf(options.plugin, options.planner));
    return chosen;
  }
  chosen.own = std::make_unique<planner::NamedPlanner>(options.planner);
  if (options.drive.any() && !chosen.own->drives())
    throw InputError({"planner '" + chosen.name() + "'", "supports neither headings nor a turning radius",
                      "pass --planner hybrid, or remove --start-heading, --goal-heading, --turning-radius "
                      "and --no-reverse"});
  return chosen;
}

// How the soil is drawn along a route.
planner::RouteRiskOptions soilOf(const planner::Problem& problem) {
  planner::RouteRiskOptions options = planner::riskOptions(*problem.map);
  options.seed = problem.seed;
  return options;
}

using Planning = std::function<planner::Plan(const planner::Problem&)>;

// `once`, repeated until the chassis that is asked for may stand all along the route.
Planning forChassis(const PlanOptions& options, const Ground& ground, const Planning& once) {
  const auto chassis = chassisOf(options.drive.chassis, ground.map);
  if (!chassis) return once;
  return [=](const planner::Problem& p) { return planner::planOnChassis(p, *chassis, once); };
}

Planning planningOf(Chosen& planner, const PlanOptions& options) {
  return [&](const planner::Problem& p) {
    if (planner.plugin) return planner.plugin->plan(p);
    return options.max_risk > 0.0 ? planner::planWithinRisk(p, *planner.own, options.max_risk, soilOf(p))
                                  : planner.own->plan(p);
  };
}

// Which of several goals the route ends at.
std::string goalText(const PlanOptions& options, const planner::Plan& plan) {
  if (options.goals.size() < 2) return "";
  return summaryLine("goal", fmt::format("{}, number {} of {}: the goal of least cost",
                                         options.goals[plan.goal], plan.goal + 1, options.goals.size()));
}

std::string planText(const Route& route, const Timing& seconds) {
  return summaryText(route) +
         summaryLine("run time", fmt::format("load {:.3f} s, costmap {:.3f} s, plan {:.3f} s", seconds.load_s,
                                             seconds.costmap_s, seconds.plan_s));
}

void writeFiles(const PlanOptions& options, const Ground& ground, const Route& route,
                const Context& context) {
  if (!options.output.empty()) {
    const auto document =
        routeGeoJson(route, ground.map.elevation(), {.files = ground.files, .seed = context.seed});
    writeFile(options.output, jsonText(document) + "\n");
  }
  if (options.html.empty() && options.png.empty()) return;
  const std::string name = std::filesystem::path(ground.map.elevation().source).filename().string();
  const std::string cut = route.interrupted ? " (interrupted: best route so far)" : "";
  Scene scene = sceneOf(ground.map, {.title = "Route across " + name + cut});
  addRoute(scene, route);
  if (!options.png.empty()) savePicture(options.png, scene);
  if (!options.html.empty()) savePage(options.html, scene);
}

// The risk once more, with soil that is alike nearby.
nlohmann::ordered_json riskJson(const Route& route, const PlanOptions& options,
                                const planner::Problem& problem) {
  const planner::RouteRiskOptions drawn = soilOf(problem);
  const planner::RouteRisk risk = planner::routeRisk(route, drawn, problem.watch);
  return {{"limit", options.max_risk},
          {"immobilisation", route.vertices.back().immobilisation_risk},
          {"correlated_soil",
           {{"immobilisation", risk.immobilisation},
            {"standard_error", risk.standard_error},
            {"cvar_reserve_std", risk.cvar},
            {"tail", drawn.tail},
            {"worst_x_m", risk.worst_x_m},
            {"worst_y_m", risk.worst_y_m}}}};
}

int exitOf(RouteStatus status) {
  switch (status) {
    case RouteStatus::Found:
      return Exit::kDone;
    case RouteStatus::Cancelled:
      return Exit::kCancelled;
    case RouteStatus::StartInvalid:
    case RouteStatus::GoalInvalid:
      return Exit::kInput;
    default:
      return Exit::kNo;
  }
}

// Says why there is no route; the exit code tells a wrong call from the answer no.
int refuse(const Route& route, const Context& context) {
  if (context.json) {
    auto json = summaryJson(route);
    json["reason"] = route.reason;
    printJson(json);
  }
  fmt::print(stderr, "talus: {}\n", oneLine(route.reason));
  return exitOf(route.status);
}

// A plan, and the ground that it was made on.
struct Planned {
  Ground ground;             // of large maps the overview
  planner::Problem problem;  // its map holds the tiles that were read
  planner::Plan plan;
  double plan_s = 0.0;
};

double since_s(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Planned planWhole(const PlanOptions& options, Chosen& planner, const Context& context) {
  Planned planned{.ground = readGround(options.ground, context), .problem = {}, .plan = {}};
  planned.problem = problemOf(options, planned.ground, context);
  const Planning plan = forChassis(options, planned.ground, planningOf(planner, options));
  const auto begin = std::chrono::steady_clock::now();
  planned.plan = plan(planned.problem);
  planned.plan_s = since_s(begin);
  return planned;
}

// Many routes over one map, over all ranks of an MPI run.
int runPairs(const PlanOptions& options, Context& context) {
  const Campaign campaign;
  if (!campaign.leads()) context.quiet = true;
  const auto pairs = readPairs(options.pairs);
  const Ground ground = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const auto lines = planPairs(pairs, problemOf(options, ground, context), options.planner, campaign);
  if (!campaign.leads()) return Exit::kDone;
  if (context.stop.stop_requested()) return Exit::kCancelled;
  if (!options.output.empty()) writeFile(options.output, pairsCsv(lines));
  if (context.json)
    printJson(nlohmann::ordered_json(lines));
  else if (options.output.empty())
    print(pairsCsv(lines));
  return Exit::kDone;
}

// A route of ours that the check refuses is an error of ours: it is kept to be sent, and none is handed out.
int refuseOwn(const PlanOptions& options, const Planned& planned, const Route& route,
              const planner::Violation& violation, const Context& context) {
  const std::string file = options.output.empty() ? "refused.geojson" : options.output + ".refused.geojson";
  const auto document = routeGeoJson(route, planned.ground.map.elevation(),
                                     {.files = planned.ground.files, .seed = context.seed});
  writeFile(file, jsonText(document) + "\n");
  Route none;
  none.status = RouteStatus::NoneFound;
  none.summary.planner = route.summary.planner;
  none.reason = fmt::format(
      "no route: the check refuses the one that '{}' found at {:.2f},{:.2f}: {}; please "
      "report it with {} and the call",
      route.summary.planner, violation.place.x_m, violation.place.y_m, violation.reason, file);
  return refuse(none, context);
}

// Both sets of cells that a proof of no route rests on.
void drawSevered(const PlanOptions& options, const Planned& planned) {
  const planner::Problem& problem = planned.problem;
  const maps::ElevationMap& map = planned.ground.map.elevation();
  const bool pictured = !options.png.empty() || !options.html.empty();
  const bool one_leg = problem.via.empty() && problem.other_goals.empty();
  if (!pictured || !one_leg || !planned.plan.obstruction || !(map.grid() == problem.map->grid())) return;
  const Scene scene = reachScene(
      map, *problem.map, {{problem.start, problem.goal}, problem.goal_tolerance_m, planned.plan.reason},
      {.title = "No route across " + std::filesystem::path(map.source).filename().string()});
  if (!options.png.empty()) savePicture(options.png, scene);
  if (!options.html.empty()) savePage(options.html, scene);
}

int finish(const PlanOptions& options, const Planned& planned, const planner::AnnotationInput& input,
           const Context& context) {
  Route route = annotated(planned.plan, input);
  if (planned.plan.status == RouteStatus::Found)
    if (const auto refused =
            planner::refusal(planned.plan, *planned.problem.map, planned.problem.kinematics.turning_radius_m))
      return refuseOwn(options, planned, route, *refused, context);
  if (planned.plan.status == RouteStatus::NoRoute) drawSevered(options, planned);
  if (planned.plan.status != RouteStatus::Found) return refuse(route, context);
  writeFiles(options, planned.ground, route, context);
  const Timing seconds{planned.ground.load_s, planned.ground.build_s, planned.plan_s};
  if (context.json) {
    nlohmann::ordered_json risk;
    if (options.max_risk > 0.0) {
      risk = riskJson(route, options, planned.problem);
      route.interrupted |= context.stop.stop_requested();  // the numbers may be missing
    }
    auto json = summaryJson(route);
    if (options.goals.size() > 1) json["goal"] = options.goals[planned.plan.goal];
    if (!risk.is_null()) json["risk"] = std::move(risk);
    json["seconds"] = {{"load", seconds.load_s}, {"costmap", seconds.costmap_s}, {"plan", seconds.plan_s}};
    printJson(json);
  } else {
    print(goalText(options, planned.plan) + planText(route, seconds));
  }
  if (!route.interrupted) return Exit::kDone;
  fmt::print(stderr,
             "talus: planning was cancelled: this is the best route so far, and its bound is weaker\n");
  return Exit::kCancelled;
}

void refuseInWindows(const PlanOptions& options) {
  const bool other = options.planner != "field" || !options.plugin.empty() || options.max_risk > 0.0 ||
                     !options.pareto.empty() || !options.pairs.empty() || !options.drive.chassis.empty() ||
                     options.goals.size() > 1;
  if (!other) return;
  throw InputError({options.ground.dem.path,
                    "is too large to be combined with --planner, --plugin, --pairs, --risk, --pareto, "
                    "--chassis or several goals",
                    "read a part with --window, or the whole with --whole-field"});
}

int runInWindows(const PlanOptions& options, const Context& context) {
  refuseInWindows(options);
  Ground overview = readOverview(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  planner::WindowedMap map = windowsOn(options.ground, overview, context);
  planner::Problem problem = problemOf(options, overview, context);
  const auto begin = std::chrono::steady_clock::now();
  planner::Plan plan = planner::planInWindows(problem, map);
  const double plan_s = since_s(begin);
  if (context.stop.stop_requested() && plan.points.empty()) return Exit::kCancelled;
  const planner::AnnotationInput input{.map = *problem.map,
                                       .elevation_m = [&](maps::Point p) { return map.elevation_m(p); },
                                       .planner = options.planner,
                                       .watch = problem.watch};
  return finish(options, {std::move(overview), problem, std::move(plan), plan_s}, input, context);
}

// A stopped call has handed out what it has: what it still does may be ended.
void letEnd(const Context& context) {
  std::fflush(stdout);
  if (context.answers_stop) *context.answers_stop = false;
}

int drawPareto(const PlanOptions& options, const Planned& planned, Chosen& planner, const Context& context) {
  const auto once = [&](const planner::Problem& p) { return planner.own->plan(p); };
  const auto front =
      planner::paretoSet(planned.problem, forChassis(options, planned.ground, once), kParetoSteps);
  if (context.stop.stop_requested()) {
    fmt::print(stderr, "talus: {} is not written: the Pareto set was cancelled; the route is whole\n",
               oneLine(options.pareto));
    letEnd(context);
    return Exit::kCancelled;
  }
  saveParetoChart(options.pareto, front);
  return Exit::kDone;
}

// A mission may come from elsewhere: of what exists, it replaces routes only.
void checkMissionOutput(const PlanOptions& options, const PlanOptions& asked, bool force) {
  if (force) return;
  const GroundOptions& ground = options.ground;
  std::vector<std::string> inputs{asked.ground.dem.path, ground.dem.path,    ground.rover,
                                  ground.soil,           ground.model,       ground.soils,
                                  ground.layers.terrain, ground.layers.rocks};
  inputs.insert(inputs.end(), ground.layers.keep_out.begin(), ground.layers.keep_out.end());
  for (const std::string& layer : ground.layers.costs) inputs.push_back(layerNamed(layer).second);
  checkOutput(options.output, inputs);
  std::string start(200, '\0');
  std::ifstream file(options.output, std::ios::binary);
  if (file && (file.read(start.data(), 200), start.find("\"Feature") == start.npos))
    throw InputError({options.output, "exists, is named by the mission alone and is no route",
                      "name it with -o, or pass --force"});
}

int run(const PlanOptions& asked, Context& context) {
  PlanOptions options = asked;
  if (isMission(options.ground.dem.path)) {
    readMission(options);
    if (asked.output.empty() && !options.output.empty()) checkMissionOutput(options, asked, context.force);
  }
  if (!context.force) checkFormat(options.output, options.pairs.empty() ? "ROUTE.geojson" : "FILE.csv");
  requirePlaces(options);
  Chosen planner = choose(options);
  if (!options.whole_field && needsWindows(options.ground, options.in_memory))
    return runInWindows(options, context);
  if (!options.pairs.empty()) return runPairs(options, context);
  const Planned planned = planWhole(options, planner, context);
  if (context.stop.stop_requested() && planned.plan.points.empty()) return Exit::kCancelled;
  const maps::Raster<float>& heights = planned.ground.map.elevation().elevation_m;
  const int code = finish(options, planned,
                          {.map = *planned.problem.map,
                           .elevation_m = maps::elevationOf(heights),
                           .planner = planner.name(),
                           .kinematics = planned.problem.kinematics,
                           .watch = planned.problem.watch},
                          context);
  if (code != Exit::kDone && context.stop.stop_requested()) letEnd(context);
  if (code == Exit::kDone && !options.pareto.empty()) return drawPareto(options, planned, planner, context);
  return code;
}

}  // namespace

void addPlan(CLI::App& app, Context& context) {
  addCommand<PlanOptions>(
      app, context,
      {.name = "plan",
       .group = Group::kRoutes,
       .description = "plan a route of least cost from start to goal",
       .examples =
           "  talus plan gale.tif --rover mer --start -4.59d,137.44d --goal -4.6d,137.5d -o route.geojson\n"
           "  talus plan mission.yaml --html route.html\n"},
      bindPlan, run);
}

}  // namespace talus::cli
