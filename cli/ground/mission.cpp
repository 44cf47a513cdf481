#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/common/input_error.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {
namespace {

using terramech::YamlFields;

// A path as the mission means it: relative to the mission's folder; a library name stays as it is.
std::string resolved(const std::string& path, const std::filesystem::path& folder) {
  const std::filesystem::path beside = folder / path;
  return !path.empty() && std::filesystem::exists(beside) ? beside.string() : path;
}

void take(std::string& option, const YamlFields& fields, const std::string& name) {
  const std::string said = fields.word(name, "");
  if (option.empty()) option = said;
}

// A number that its option takes, too.
double ranged(const YamlFields& fields, const std::string& name, const CLI::Validator& range) {
  const double value = fields.number(name);
  std::string text = fmt::format("{}", value);
  if (const std::string fault = range(text); !fault.empty())
    fields.refuse(name, name + " = " + fault, "correct the value");
  return value;
}

// "x,y" from a text or from a list of two numbers.
std::string place(const YamlFields& fields, const std::string& name) {
  if (!fields.has(name)) return "";
  try {
    const auto numbers = fields.numbers(name);
    if (numbers.size() == 2) return fmt::format("{},{}", numbers[0], numbers[1]);
  } catch (const InputError&) {
  }
  return fields.word(name);
}

// One place, or a list of them.
std::vector<std::string> places(const YamlFields& fields, const std::string& name) {
  try {
    if (fields.numbers(name).size() == 2) return {place(fields, name)};
  } catch (const InputError&) {
  }
  return fields.texts(name);
}

void readMaps(const YamlFields& maps, GroundOptions& ground, const std::filesystem::path& folder) {
  maps.only({"dem", "map", "terrain", "rocks", "keep_out", "resolution_m", "ignore_crs"});
  ground.dem.path = resolved(maps.word("dem", ""), folder);
  take(ground.map_file, maps, "map");
  take(ground.layers.terrain, maps, "terrain");
  take(ground.layers.rocks, maps, "rocks");
  if (maps.has("keep_out")) ground.layers.keep_out.push_back(resolved(maps.word("keep_out"), folder));
  if (maps.has("resolution_m") && !ground.dem.read.resolution_m)
    ground.dem.read.resolution_m = maps.number("resolution_m");
  if (maps.flag("ignore_crs", false)) ground.dem.read.ignore_crs = true;
  for (std::string* path : {&ground.map_file, &ground.layers.terrain, &ground.layers.rocks})
    *path = resolved(*path, folder);
  if (ground.dem.path.empty() && ground.map_file.empty())
    maps.refuse("", "defines no map", "give dem: FILE, or map: FILE.ot");
  if (ground.dem.path.empty()) ground.dem.path = ground.map_file;
}

// What differs from its default was said on the command line and holds.
void readThresholds(const YamlFields& fields, costmap::DrivePolicy& policy) {
  fields.only({"slope_margin_rad", "sinkage_threshold", "sinkage_critical", "max_immobilisation",
               "allow_marginal", "allow_dangerous", "allow_unknown", "time_weight_W", "risk_weight_J"});
  const costmap::DrivePolicy defaults;
  const auto number = [&](double costmap::DrivePolicy::*field, const char* name) {
    const double said = fields.number(name, policy.*field);
    if (policy.*field == defaults.*field) policy.*field = said;
  };
  const auto flag = [&](bool costmap::DrivePolicy::*field, const char* name) {
    const bool said = fields.flag(name, policy.*field);
    if (policy.*field == defaults.*field) policy.*field = said;
  };
  number(&costmap::DrivePolicy::slope_margin_rad, "slope_margin_rad");
  number(&costmap::DrivePolicy::sinkage_threshold, "sinkage_threshold");
  number(&costmap::DrivePolicy::sinkage_critical, "sinkage_critical");
  number(&costmap::DrivePolicy::max_immobilisation, "max_immobilisation");
  flag(&costmap::DrivePolicy::allow_marginal, "allow_marginal");
  flag(&costmap::DrivePolicy::allow_dangerous, "allow_dangerous");
  flag(&costmap::DrivePolicy::allow_unknown, "allow_unknown");
  number(&costmap::DrivePolicy::time_weight_W, "time_weight_W");
  number(&costmap::DrivePolicy::risk_weight_J, "risk_weight_J");
}

}  // namespace

bool isMission(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

void readMission(PlanOptions& options) {
  const std::filesystem::path path = options.ground.dem.path;
  const std::filesystem::path folder = path.parent_path();
  const YamlFields fields = YamlFields::file(path.string());
  fields.only({"maps", "rover", "soil", "model", "soils", "thresholds", "planner", "start", "goal", "via",
               "tolerance_m", "time_s", "start_heading_rad", "goal_heading_rad", "reverse", "output"});
  readMaps(fields.fields("maps"), options.ground, folder);
  take(options.ground.rover, fields, "rover");
  take(options.ground.soil, fields, "soil");
  take(options.ground.model, fields, "model");
  take(options.ground.soils, fields, "soils");
  for (std::string* file :
       {&options.ground.rover, &options.ground.soil, &options.ground.model, &options.ground.soils})
    *file = resolved(*file, folder);
  if (fields.has("thresholds")) readThresholds(fields.fields("thresholds"), options.ground.policy);
  if (options.planner == "field") options.planner = fields.word("planner", "field");
  if (options.start.empty()) options.start = place(fields, "start");
  if (options.goals.empty()) options.goals = places(fields, "goal");
  if (options.via.empty()) options.via = places(fields, "via");
  for (const auto& [heading, key] : {std::pair{&options.drive.start_heading_rad, "start_heading_rad"},
                                     std::pair{&options.drive.goal_heading_rad, "goal_heading_rad"}})
    if (!*heading && fields.has(key)) *heading = ranged(fields, key, finite());
  if (!fields.flag("reverse", true)) options.drive.no_reverse = true;
  if (options.tolerance_m == 0.0 && fields.has("tolerance_m"))
    options.tolerance_m = ranged(fields, "tolerance_m", notNegative());
  if (options.time_limit_s == 0.0 && fields.has("time_s"))
    options.time_limit_s = ranged(fields, "time_s", positive());
  take(options.output, fields, "output");
}

}  // namespace talus::cli
