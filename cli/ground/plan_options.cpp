#include <CLI/CLI.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/ground/plan_options.hpp>
#include <talus/common/common.hpp>
#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::cli {

void addHeading(CLI::App& command, const std::string& name, std::optional<double>& heading_rad,
                const std::string& text) {
  auto* radians = command
                      .add_option_function<double>(
                          name, [&heading_rad](double value) { heading_rad = value; }, text)
                      ->type_name("RAD")
                      ->check(heading());
  command
      .add_option_function<double>(
          name + "-deg", [&heading_rad](double value) { heading_rad = value * kDegree; },
          "the same in degrees")
      ->type_name("DEG")
      ->check(finite())
      ->excludes(radians);
}

void addMotionOptions(CLI::App& command, MotionOptions& drive) {
  constexpr const char* kText = "heading of the rover there, counter-clockwise from east (default: any)";
  addHeading(command, "--start-heading", drive.start_heading_rad, kText);
  addHeading(command, "--goal-heading", drive.goal_heading_rad, kText);
  command
      .add_option_function<double>(
          "--turning-radius", [&drive](double value) { drive.turning_radius_m = value; },
          "minimum turning radius of hybrid; 0: turns in place (default: the rover's)")
      ->type_name("METRES")
      ->check(turningRadius());
  addChassisOption(command, drive.chassis);
  command.add_flag("--no-reverse", drive.no_reverse, "hybrid: do not drive in reverse");
  groupOptions(command, "Motion");
}

CLI::Validator turningRadius() {
  const auto check = [](const std::string& text) -> std::string {
    double radius_m = 0.0;
    const bool allowed = CLI::detail::lexical_cast(text, radius_m) && terramech::isTurningRadius(radius_m);
    return allowed ? "" : text + ", must be 0 or 0.001 to 1000";
  };
  return CLI::Validator(check, "");
}

void addChassisOption(CLI::App& command, std::string& chassis) {
  addOption(command, "--chassis KIND", chassis,
            "check clearance, pitch and roll of this chassis along the whole motion (any planner)")
      ->check(CLI::IsMember({"rigid", "rocker-bogie"}));
}

planner::Kinematics kinematicsOf(const MotionOptions& drive, const costmap::TraversabilityMap& map) {
  planner::Kinematics kinematics = planner::kinematicsOn(map.model(), map.published()->cost());
  if (drive.turning_radius_m) kinematics.turning_radius_m = *drive.turning_radius_m;
  kinematics.may_reverse = !drive.no_reverse;
  return kinematics;
}

std::optional<planner::Chassis> chassisOf(const std::string& kind, const costmap::TraversabilityMap& map) {
  if (kind.empty()) return std::nullopt;
  return planner::Chassis(map.elevation().elevation_m, map.model().rover(),
                          kind == "rigid" ? planner::Suspension::Rigid : planner::Suspension::RockerBogie);
}

namespace {

void addOutputs(CLI::App& command, PlanOptions& options) {
  addOutput(command, "-o,--output ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|FILE.csv", options.output,
            "route to write; GPX and KML of Earth alone; CSV with --pairs");
  addOutput(command, "--html PAGE.html", options.html, "page to write: map, route and profiles");
  addOutput(command, "--png FILE.png", options.png, "picture to write");
  addImageOption(command, options.image);
  groupOptions(command, "Output");
}

void addPairs(CLI::App& command, PlanOptions& options) {
  addOption(command, "--pairs FILE.csv", options.pairs,
            "plan many routes over one map: CSV with start_x_m, start_y_m, goal_x_m, goal_y_m; one row "
            "of results each, to -o FILE.csv or stdout; distributed over all ranks under mpirun");
  addOption(command, "--part K/N", options.part,
            "plan part K of N of the pairs alone; the rows of the parts make the table")
      ->needs("--pairs");
}

}  // namespace

void addPluginOption(CLI::App& command, std::string& plugin) {
  addOption(command, "--plugin FILE.so", plugin,
            "plan by a planner plugin instead; its route is checked, and the cost is the program's own");
}

void addImageOption(CLI::App& command, std::string& image) {
  addOption(command, "--image ORTHO.tif", image,
            "picture of the ground, such as an orthophoto, to show under the route")
      ->check(CLI::ExistingFile);
}

void addPluginTime(CLI::App& command, double& time_limit_s) {
  addOption(command, "--time S", time_limit_s,
            "time limit of the plugin for each plan, which it is ended a second after (default: none)")
      ->check(positive())
      ->needs(command.get_option("--plugin"));
}

void bindPlan(CLI::App& command, PlanOptions& options) {
  addGroundOptions(command, options.ground);
  addCostCurve(command, options.ground);
  addOption(command, "--start PLACE", options.start,
            "start: x,y in map metres; lat,lon with the suffix d on each; or a vector file");
  addOption(command, "--goal PLACE", options.goals,
            "goal, in the same formats; may be repeated: the goal of least cost is chosen");
  addOption(command, "--via PLACE", options.via, "via point; may be repeated");
  addPairs(command, options);
  addOption(command, "--tolerance METRES", options.tolerance_m,
            "goal tolerance: largest distance between the end of the route and the goal")
      ->check(notNegative());
  groupOptions(command, "Places");
  addOption(command, "--planner NAME", options.planner, "planner; `talus plugins` lists them")
      ->capture_default_str();
  addPluginOption(command, options.plugin);
  addOption(command, "--time S", options.time_limit_s, "time limit of planning")->check(positive());
  addOption(command, "--in-memory CELLS", options.in_memory,
            "largest DEM that is read whole; a larger one is read in windows along a route over its overview")
      ->check(notNegative())
      ->capture_default_str();
  command.add_flag("--no-proof", options.no_proof,
                   "do not search a lower bound, nor its region for a cheaper route: quicker, for loops");
  addOption(command, "--gap SHARE", options.gap,
            "end at this proven gap: share of the cost above its lower bound")
      ->check(within(1e-4, 0.99))
      ->excludes("--no-proof");
  addOption(command, "--corridor PERCENT", options.corridor_percent,
            "write to -o AREA.gpkg the area that every route within this excess over the cost stays in")
      ->check(within(0.01, 1000.0));
  addOption(command, "--risk ALPHA", options.max_risk,
            "upper limit of the immobilisation probability of the route")
      ->check(within(1e-12, 1.0 - 1e-12));
  groupOptions(command, "Planner");
  addMotionOptions(command, options.drive);
  addOutputs(command, options);
}

void requirePlaces(const PlanOptions& options) {
  const bool one_leg = options.pairs.empty() && options.via.empty() && options.goals.size() < 2;
  if (options.corridor_percent > 0.0 && !(one_leg && options.output.ends_with(".gpkg")))
    throw InputError({"--corridor", "needs one start, one goal and -o AREA.gpkg",
                      "remove --via, --pairs and further goals, and name a file .gpkg"});
  if ((options.ground.is_cost || !options.ground.cost_curve.empty()) &&
      (options.max_risk > 0.0 || !options.drive.chassis.empty()))
    throw InputError({"talus plan", "a stated cost has neither a risk nor a chassis",
                      "remove --risk and --chassis, or plan with a rover"});
  if (!options.pairs.empty()) {
    if (!options.start.empty() || !options.goals.empty() || !options.via.empty() || !options.html.empty() ||
        !options.png.empty() || options.max_risk > 0.0 || !options.drive.chassis.empty() ||
        !options.plugin.empty())
      throw InputError({"--pairs " + options.pairs,
                        "cannot be combined with --start, --goal, --via, --html, --png, --risk, "
                        "--chassis or --plugin",
                        "remove them, or plan the routes one by one"});
    return;
  }
  if (!options.plugin.empty() && options.max_risk > 0.0)
    throw InputError({"--plugin " + options.plugin, "cannot be combined with --risk",
                      "remove one of them, or plan with a planner of the program"});
  if (options.start.empty()) throw InputError({"talus plan", "no start", "pass --start x,y"});
  if (options.goals.empty()) throw InputError({"talus plan", "no goal", "pass --goal x,y"});
}

}  // namespace talus::cli
