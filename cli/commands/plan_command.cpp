// talus plan DEM --start P --goal P: plans a route.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/command.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/vector/vector_writer.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;
using planner::RouteStatus;

Planner plannerOf(const PlanOptions& options, const Context& context) {
  const bool plugin = !options.plugin.empty();
  PlannerSettings settings{.planner = plugin && options.planner == "field" ? std::string() : options.planner,
                           .seed = context.seed,
                           .threads = context.workers()};
  if (options.time_limit_s > 0.0) settings.time_limit_s = options.time_limit_s;
  Planner own(settings, options.plugin);
  if (!plugin && options.drive.any() && !own.capabilities().headings)
    throw InputError({"planner '" + own.name() + "'", "supports neither headings nor a turning radius",
                      "pass --planner hybrid, or remove --start-heading, --goal-heading, --turning-radius "
                      "and --no-reverse"});
  return own;
}

PlanRequest requestOf(const PlanOptions& options, const PlannerCapabilities& offers, const Ground& ground,
                      const Context& context) {
  const maps::ElevationMap& map = ground.map.elevation();
  PlanRequest request;
  planner::requireRouteFormat(options.output, map);
  if (options.pairs.empty()) {
    request.start = maps::readPlace(options.start, map, "--start");
    request.goal = maps::readPlace(options.goals.front(), map, "--goal");
    for (auto goal = options.goals.begin() + 1; goal != options.goals.end(); ++goal)
      request.other_goals.push_back(maps::readPlace(*goal, map, "--goal"));
  }
  for (const std::string& place : options.via) request.via.push_back(maps::readPlace(place, map, "--via"));
  request.tolerance_m = options.tolerance_m;
  request.start_heading_rad = options.drive.start_heading_rad;
  request.goal_heading_rad = options.drive.goal_heading_rad;
  if (offers.turning_radius) request.kinematics = kinematicsOf(options.drive, ground.map);
  if (auto chassis = chassisOf(options.drive.chassis, ground.map))
    request.chassis = std::make_shared<const planner::Chassis>(*std::move(chassis));
  if (options.max_risk > 0.0) request.risk_limit = RiskLimit{.immobilisation = options.max_risk};
  request.prove = !options.no_proof;
  request.gap = options.gap;
  request.watch = context.watch("plan");
  if (options.plugin.empty()) context.answerStop();  // a plugin returns no partial route
  return request;
}

// Summary line with the chosen goal; empty for a single goal.
std::string goalText(const PlanOptions& options, const Route& route) {
  if (options.goals.size() < 2) return "";
  return summaryLine("goal", fmt::format("{}, number {} of {}: the goal of least cost",
                                         options.goals[route.goal], route.goal + 1, options.goals.size()));
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

// Prints the reason why there is no route. The exit code distinguishes an invalid call from a negative
// result.
int refuse(const Route& route, const Context& context) {
  if (context.json) {
    auto json = summaryJson(route);
    json["reason"] = route.reason;
    printJson(json);
  }
  printError(fmt::format("talus: {}\n", oneLine(route.reason)));
  return exitOf(route.status);
}

// A route, and the ground on which it was planned.
struct Planned {
  Ground ground;  // for large maps the overview
  PlanRequest request;
  Route route;
  double plan_s = 0.0;                    // includes the proof
  maps::Raster<std::uint32_t> picture{};  // of the ground, read before planning; empty: none
};

void writeFiles(const PlanOptions& options, const Planned& planned, const Context& context) {
  const Ground& ground = planned.ground;
  const Route& route = planned.route;
  const planner::RouteOrigin origin = originOf(ground, context);
  const auto document = routeGeoJson(route, ground.map.elevation(), origin);
  if (!options.output.empty() && !(options.corridor_percent > 0.0))
    planner::writeRoute(options.output, document, ground.map.elevation(),
                        [&](std::string_view line) { context.warn(line); });
  if (options.html.empty() && options.png.empty()) return;
  const ProgressMonitor drawing = context.watch("draw");
  const std::string name = std::filesystem::path(ground.map.elevation().source).filename().string();
  const std::string cut = route.interrupted ? " (interrupted: best route so far)" : "";
  Scene scene = sceneOf(ground.map, {.title = "Route across " + name + cut});
  scene.image = planned.picture;
  addRoute(scene, route);
  addProvenance(scene, origin);
  saveScene(scene, options.html, options.png);
}

std::string planText(const Planned& planned) {
  const Route& route = planned.route;
  const std::string proof = route.proof_s > 0.0 ? fmt::format(" (proof {:.3f} s)", route.proof_s) : "";
  return summaryText(route) +
         summaryLine("run time",
                     fmt::format("load {:.3f} s, costmap {:.3f} s, plan {:.3f} s{}", planned.ground.load_s,
                                 planned.ground.build_s, planned.plan_s, proof));
}

// Writes the cells outside of which no route is within the stated excess over the cost of the route.
void writeCorridor(const PlanOptions& options, const Planned& planned, const Context& context) {
  const auto map = planned.ground.map.published();
  const PlanRequest& asked = planned.request;
  const std::vector<bool> inside = planner::LowerBound().corridor(
      map, {asked.start, asked.goal}, asked.tolerance_m,
      (1.0 + 0.01 * options.corridor_percent) * planned.route.cost, context.watch("corridor"));
  maps::Raster<std::uint8_t> area(map->grid(), 1);
  for (std::size_t i = 0; i < inside.size(); ++i) area.values()[i] = inside[i] ? 1 : 0;
  writeFile(options.output, maps::areaFile(planned.ground.map.elevation(), area, "corridor", options.output));
}

Planned timedPlan(Ground ground, PlanRequest request, const std::function<Route(const PlanRequest&)>& plan) {
  const auto begin = std::chrono::steady_clock::now();
  request.hazards = [&map = ground.map](maps::Cell cell) { return map.surface().hazards(cell); };
  Route route = plan(request);
  request.hazards = {};  // refers to the map, which is moved
  request.watch.progress = {};
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  return {std::move(ground), std::move(request), std::move(route), seconds.count()};
}

// Immobilisation risk of the route by simulation with correlated soil.
nlohmann::ordered_json riskJson(const Planned& planned, const Context& context) {
  const Route& route = planned.route;
  const RiskLimit& limit = *planned.request.risk_limit;
  const planner::RouteRiskOptions drawn =
      planner::riskOptions(*planned.ground.map.published(), limit, context.seed);
  const planner::RouteRisk risk = planner::routeRisk(route, drawn, planned.request.watch);
  return {{"limit", limit.immobilisation},
          {"immobilisation", route.vertices.back().immobilisation_risk},
          {"correlated_soil",
           {{"immobilisation", risk.immobilisation},
            {"standard_error", risk.standard_error},
            {"cvar_reserve_std", risk.cvar},
            {"tail", drawn.tail},
            {"worst_x_m", risk.worst_x_m},
            {"worst_y_m", risk.worst_y_m}}}};
}

/// Start and goal of one of several routes.
struct PlacePair {
  maps::Point start;
  maps::Point goal;
  /// Heading at the start, for planners of drives (paths with headings).
  std::optional<double> start_heading_rad;
  /// Heading at the goal.
  std::optional<double> goal_heading_rad;
};

Json planned(const PlacePair& pair, const std::shared_ptr<const costmap::CostGrid>& map, PlanRequest request,
             Planner& planner) {
  request.watch.progress = {};
  request.start = pair.start;
  request.goal = pair.goal;
  const bool headings = planner.capabilities().headings;
  if (headings && pair.start_heading_rad) request.start_heading_rad = pair.start_heading_rad;
  if (headings && pair.goal_heading_rad) request.goal_heading_rad = pair.goal_heading_rad;
  const Route route = planner.plan(map, request);
  Json line = summaryJson(route);
  if (route.status != planner::RouteStatus::Found) line["reason"] = route.reason;
  return line;
}

std::string cell(const Json& line, const char* key) {
  const auto value = line.find(key);
  if (value == line.end() || value->is_null()) return {};
  return value->is_string() ? value->get<std::string>() : jsonText(*value);
}

/// Returns the pairs of starts and goals of a CSV table with the columns start_x_m, start_y_m, goal_x_m,
/// goal_y_m and, if present, start_heading_rad and goal_heading_rad. @throws InputError with file, line and
/// column
std::vector<PlacePair> readPairs(const std::string& path) {
  constexpr double kGreatest = 1e9;  // as in telemetry; beyond any map, and any heading
  terramech::CsvReader reader(path);
  terramech::CsvRow row;
  const auto refuse = [&](const std::string& reason, const char* remedy) {
    throw InputError({fmt::format("{}:{}", path, std::max<std::size_t>(1, row.line)), reason, remedy});
  };
  const auto column = [&](const char* name) { return std::ranges::find(reader.header(), name); };
  const auto number = [&](const char* name) {
    const std::string& field = row.fields[static_cast<std::size_t>(column(name) - reader.header().begin())];
    double value = 0.0;
    if (!terramech::parseNumber(field, value) || !std::isfinite(value))
      refuse(fmt::format("{} = '{}' is not a finite number", name, field), "fix the line");
    if (std::abs(value) > kGreatest)
      refuse(fmt::format("{} = {:g}, must be within {:g} of 0", name, value, kGreatest),
             "give metres and radians");
    return value;
  };
  const auto heading = [&](const char* name) -> std::optional<double> {
    const auto at = column(name);
    if (at == reader.header().end()) return std::nullopt;
    if (row.fields[static_cast<std::size_t>(at - reader.header().begin())].empty()) return std::nullopt;
    return number(name);
  };
  for (const char* name : {"start_x_m", "start_y_m", "goal_x_m", "goal_y_m"})
    if (column(name) == reader.header().end())
      refuse(fmt::format("has no column {}", name), "give start_x_m, start_y_m, goal_x_m, goal_y_m");
  std::vector<PlacePair> pairs;
  while (reader.next(row)) {
    if (!row.fault.empty()) refuse(row.fault, "fix the line");
    pairs.push_back({{number("start_x_m"), number("start_y_m")},
                     {number("goal_x_m"), number("goal_y_m")},
                     heading("start_heading_rad"),
                     heading("goal_heading_rad")});
  }
  if (pairs.empty()) throw InputError({path, "contains no pair", "add one line per start and goal"});
  return pairs;
}

/// Returns results of pairs as CSV: pair, status, planner, cost, energy_J, time_s, length_m,
/// max_slip, max_slope_rad, lower_bound, gap, immobilisation_risk, reason.
std::string pairsCsv(const std::vector<Json>& lines) {
  constexpr std::array keys{"pair",          "status",      "planner",  "cost",
                            "energy_J",      "time_s",      "length_m", "max_slip",
                            "max_slope_rad", "lower_bound", "gap",      "immobilisation_risk",
                            "reason"};
  Table table{{keys.begin(), keys.end()}};
  for (const Json& line : lines) {
    table.emplace_back();
    for (const char* key : keys) table.back().push_back(cell(line, key));
  }
  return csvText(table);
}

// Plans many routes on one map, distributed over the ranks of an MPI run. An error in one pair becomes its reason and
// stops no other pair.
int runPairs(const PlanOptions& options, Planner& planner, Context& context) {
  const Campaign campaign;
  if (!campaign.leads()) context.quiet = true;
  const auto pairs = readPairs(options.pairs);
  const Ground ground = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const auto map = ground.map.published();
  const PlanRequest request = requestOf(options, planner.capabilities(), ground, context);
  const auto results = campaign.results(
      {.count = pairs.size(), .part = options.part},
      [&](std::size_t i) { return jsonText(planned(pairs[i], map, request, planner)); }, request.watch);
  if (!results) return Exit::kDone;
  if (context.stop.stop_requested()) return Exit::kCancelled;
  std::vector<Json> lines;
  for (const auto& [pair, text] : *results) {
    lines.push_back({{"pair", pair + 1}});
    const Json line = Json::parse(text, nullptr, false);  // or the reason of a failure
    lines.back().update(line.is_object() ? line : Json{{"status", "failed"}, {"reason", text}});
  }
  if (!options.output.empty()) writeFile(options.output, pairsCsv(lines));
  if (context.json)
    printJson(nlohmann::ordered_json(lines));
  else if (options.output.empty())
    print(pairsCsv(lines));
  return Exit::kDone;
}

// Handles an own route that the check refuses, which is an internal error: writes the route to a file for a
// bug report and returns no route.
int refuseOwn(const PlanOptions& options, const Planned& planned, const Context& context) {
  const std::string file = options.output.empty() ? "refused.geojson" : options.output + ".refused.geojson";
  const auto document =
      routeGeoJson(*planned.route.refused, planned.ground.map.elevation(), originOf(planned.ground, context));
  writeFile(file, jsonText(document) + "\n");
  Route none = planned.route;
  none.reason += fmt::format(" with {} and the call", file);
  return refuse(none, context);
}

// Draws the two sets of cells on which the proof of infeasibility is based.
void drawSevered(const PlanOptions& options, const Planned& planned, const Context& context) {
  const PlanRequest& request = planned.request;
  const maps::ElevationMap& map = planned.ground.map.elevation();
  const bool pictured = !options.png.empty() || !options.html.empty();
  const bool one_leg = request.via.empty() && request.other_goals.empty();
  if (!pictured || !one_leg || !planned.route.obstruction) return;
  const ProgressMonitor drawing = context.watch("draw");
  Scene scene =
      reachScene(map, *planned.ground.map.published(),
                 {{request.start, request.goal}, request.tolerance_m, planned.route.reason},
                 {.title = "No route across " + std::filesystem::path(map.source).filename().string()});
  addProvenance(scene, originOf(planned.ground, context));
  saveScene(scene, options.html, options.png);
}

int finish(const PlanOptions& options, Planned& planned, const Context& context) {
  Route& route = planned.route;
  if (route.refused) return refuseOwn(options, planned, context);
  if (route.status == RouteStatus::NoRoute) drawSevered(options, planned, context);
  if (route.status != RouteStatus::Found) return refuse(route, context);
  if (options.corridor_percent > 0.0) writeCorridor(options, planned, context);
  writeFiles(options, planned, context);
  if (context.json) {
    nlohmann::ordered_json risk;
    if (planned.request.risk_limit) {
      risk = riskJson(planned, context);
      route.interrupted |= context.stop.stop_requested();  // simulations may be missing
    }
    auto json = summaryJson(route);
    if (options.goals.size() > 1) json["goal"] = options.goals[route.goal];
    if (!risk.is_null()) json["risk"] = std::move(risk);
    json["seconds"] = {{"load", planned.ground.load_s},
                       {"costmap", planned.ground.build_s},
                       {"plan", planned.plan_s},
                       {"proof", route.proof_s}};
    printJson(json);
  } else {
    print(goalText(options, route) + planText(planned));
  }
  if (!route.interrupted) return Exit::kDone;
  printError("talus: planning was cancelled: this is the best route so far, and its bound is weaker\n");
  return Exit::kCancelled;
}

void refuseInWindows(const PlanOptions& options) {
  const bool other = options.planner != "field" || !options.plugin.empty() || options.max_risk > 0.0 ||
                     !options.pairs.empty() || !options.drive.chassis.empty() || options.goals.size() > 1;
  if (!other) return;
  throw InputError({options.ground.elevation.path,
                    "is too large to be combined with --planner, --plugin, --pairs, --risk, "
                    "--chassis or several goals",
                    "read a part with --window, or the whole with a greater --in-memory"});
}

// After a stopped call has printed its results, remaining work may be terminated.
void letEnd(const Context& context) {
  std::fflush(stdout);
  if (context.answers_stop) *context.answers_stop = false;
}

// Plans one route, on the whole map or in windows of a large one.
int runOne(const PlanOptions& options, bool windows, Planner& planner, const Context& context) {
  if (windows) refuseInWindows(options);
  Ground ground = windows ? readOverview(options.ground, context) : readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  std::optional<planner::WindowedMap> parts;
  if (windows) parts.emplace(windowsOn(options.ground, ground, context));
  PlanRequest request = requestOf(options, planner.capabilities(), ground, context);
  const auto map = ground.map.published();
  const maps::ElevationMap& heights = ground.map.elevation();
  maps::Raster<std::uint32_t> picture = groundPicture(options.image, heights.georeference, heights.grid());
  Planned route = timedPlan(std::move(ground), std::move(request), [&](const PlanRequest& asked) {
    return parts ? planner.plan(*parts, asked) : planner.plan(map, asked);
  });
  route.picture = std::move(picture);
  if (context.stop.stop_requested() && route.route.vertices.empty()) return Exit::kCancelled;
  const int code = finish(options, route, context);
  if (code != Exit::kDone && context.stop.stop_requested()) letEnd(context);
  return code;
}

// Returns true if the file is a route that was planned for this mission, as it is or as it was before a change.
bool isRouteOf(const std::string& mission, const std::string& path) {
  try {
    const auto inputs = readRoute(path).inputs;
    return std::ranges::any_of(inputs, [&](const InputFile& input) {
      std::error_code error;
      return input.role == "mission" && (std::filesystem::equivalent(input.path, mission, error) ||
                                         input.sha256 == sha256OfFile(mission));
    });
  } catch (const InputError&) {
    return false;
  }
}

// Mission files may come from other sources: without --force, their outputs overwrite only their own routes.
void checkMissionOutput(const PlanOptions& options) {
  std::vector<std::string> inputs;
  for (const InputFile& input : filesOf(options.ground.files())) inputs.push_back(input.path);
  checkOutput(options.output, inputs);
  if (std::filesystem::exists(options.output) && !isRouteOf(options.ground.mission, options.output))
    throw InputError({options.output, "exists, is named by the mission alone and is no route of this mission",
                      "name it with -o, or pass --force"});
}

int run(PlanOptions& options, Context& context) {
  const bool names_output = !options.output.empty();
  readMission(options);
  if (!context.force && !names_output && !options.output.empty()) checkMissionOutput(options);
  if (!context.force) checkFormat(options.output, options.pairs.empty() ? planner::kRouteFiles : "FILE.csv");
  requirePlaces(options);
  Planner planner = plannerOf(options, context);
  const bool windows = !(options.corridor_percent > 0.0) && !options.ground.is_cost &&
                       needsWindows(options.ground, options.in_memory);
  return windows || options.pairs.empty() ? runOne(options, windows, planner, context)
                                          : runPairs(options, planner, context);
}

}  // namespace

void addPlan(CLI::App& app, Context& context) {
  addCommand<PlanOptions>(app, context, "plan", bindPlan, run);
}

}  // namespace talus::cli
