#include <algorithm>
#include <cmath>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/app/texts.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/common/common.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {

void addHeading(CLI::App& command, const std::string& name, std::optional<double>& heading_rad) {
  auto* radians = addOption(command, name + " RAD", heading_rad)->check(heading());
  command
      .add_option_function<double>(name + "-deg", [&heading_rad](double deg) { heading_rad = deg * kDegree; })
      ->type_name("DEG")
      ->check(finite())
      ->excludes(radians);
}

void addMotionOptions(CLI::App& command, MotionOptions& drive) {
  addHeading(command, "--start-heading", drive.start_heading_rad);
  addHeading(command, "--goal-heading", drive.goal_heading_rad);
  addOption(command, "--turning-radius METRES", drive.turning_radius_m)->check(turningRadius());
  addChassisOption(command, drive.chassis);
  command.add_flag("--no-reverse", drive.no_reverse);
}

CLI::Validator turningRadius() {
  return numberThat(terramech::isTurningRadius, "0 or 0.001 to 1000");
}

void addChassisOption(CLI::App& command, std::string& chassis) {
  addOption(command, "--chassis KIND", chassis)->check(CLI::IsMember({"rigid", "rocker-bogie"}));
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

void bindPlan(CLI::App& command, PlanOptions& options) {
  addGroundOptions(command, options.ground);
  addCostCurve(command, options.ground);
  addOption(command, "--start PLACE", options.start);
  addOption(command, "--goal PLACE", options.goals);
  addOption(command, "--via PLACE", options.via);
  addOption(command, "--pairs FILE.csv", options.pairs);
  addOption(command, "--part K/N", options.part)->needs("--pairs");
  addOption(command, "--tolerance METRES", options.tolerance_m)->check(notNegative());
  addOption(command, "--planner NAME", options.planner);
  addOption(command, "--plugin FILE.so", options.plugin);
  addOption(command, "--time S", options.time_limit_s)->check(positive());
  addOption(command, "--in-memory CELLS", options.in_memory)->check(notNegative());
  command.add_flag("--no-proof", options.no_proof);
  addOption(command, "--gap SHARE", options.gap)->check(within(1e-4, 0.99))->excludes("--no-proof");
  addOption(command, "--corridor PERCENT", options.corridor_percent)->check(within(0.01, 1000.0));
  addOption(command, "--risk ALPHA", options.max_risk)->check(within(1e-12, 1.0 - 1e-12));
  addMotionOptions(command, options.drive);
  addOutput(command, "-o,--output ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|FILE.csv", options.output);
  addOutput(command, "--html PAGE.html", options.html);
  addOutput(command, "--png FILE.png", options.png);
  addOption(command, "--image ORTHO.tif", options.image)->check(CLI::ExistingFile);
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

namespace {

using terramech::FileKey;
using terramech::YamlFields;

// Path of a file that a mission names: relative to its folder.
std::string beside(const std::string& path, const std::filesystem::path& folder) {
  return path.empty() ? path : (folder / path).string();
}

// A rover or soil: a YAML file, or else a name of the library.
std::string fileOrName(const std::string& word, const std::filesystem::path& folder) {
  const bool names_file = word.ends_with(".yaml") || word.ends_with(".yml") || word.find('/') != word.npos;
  return names_file ? beside(word, folder) : word;
}

// A number checked with the validator of the corresponding option.
double ranged(const YamlFields& fields, const std::string& name, const CLI::Validator& range) {
  const double value = fields.number(name);
  std::string text = fmt::format("{}", value);
  if (const std::string fault = range(text); !fault.empty())
    fields.refuse(name, name + " = " + fault, "correct the value");
  return value;
}

// One place or a list of places: texts, vector files or one list of two numbers.
std::vector<std::string> places(const YamlFields& fields, const std::string& name,
                                const std::filesystem::path& folder) {
  try {
    if (const auto numbers = fields.numbers(name); numbers.size() == 2)
      return {fmt::format("{},{}", numbers[0], numbers[1])};
  } catch (const InputError&) {
  }
  std::vector<std::string> words = fields.texts(name);
  for (std::string& word : words)
    if (maps::isNamedAsVector(word)) word = beside(word, folder);
  return words;
}

// One place; empty without the key.
std::string place(const YamlFields& fields, const std::string& name, const std::filesystem::path& folder) {
  const auto found = fields.has(name) ? places(fields, name, folder) : std::vector<std::string>();
  if (found.size() > 1) fields.refuse(name, name + " is a list of places", "write one place");
  return found.empty() ? "" : found.front();
}

void readMaps(const YamlFields& maps, GroundOptions& ground, const std::filesystem::path& folder) {
  maps.only(namesOf(keysOf("Mission: maps")));
  ground.elevation.path = beside(maps.word("dem", ""), folder);
  ground.map_file = beside(maps.word("map", ""), folder);
  ground.classes = beside(maps.word("terrain", ""), folder);
  ground.rocks = beside(maps.word("rocks", ""), folder);
  if (maps.has("resolution_m")) ground.elevation.read.resolution_m = maps.number("resolution_m");
  ground.elevation.read.ignore_crs = maps.flag("ignore_crs", false);
}

void readThresholds(const YamlFields& fields, costmap::TravelPolicy& policy) {
  using Policy = costmap::TravelPolicy;
  fields.only(namesOf(keysOf("Mission: thresholds")));
  for (const auto& [name, field] : {std::pair{"slope_margin_rad", &Policy::slope_margin_rad},
                                    {"sinkage_threshold", &Policy::sinkage_threshold},
                                    {"sinkage_critical", &Policy::sinkage_critical},
                                    {"max_immobilisation", &Policy::max_immobilisation},
                                    {"time_weight_W", &Policy::time_weight_W},
                                    {"risk_weight_J", &Policy::risk_weight_J}})
    policy.*field = fields.number(name, policy.*field);
  for (const auto& [name, field] : {std::pair{"allow_marginal", &Policy::allow_marginal},
                                    {"allow_dangerous", &Policy::allow_dangerous},
                                    {"allow_unknown", &Policy::allow_unknown}})
    policy.*field = fields.flag(name, policy.*field);
}

// Returns true if the call states an option.
bool isStated(const CLI::App* call, const char* option) {
  return call != nullptr && call->get_option(option)->count() > 0;
}

// Assigns the options that the call states once more, over the values of its mission.
void applyCall(CLI::App* call) {
  if (call == nullptr) return;
  for (CLI::Option* option : call->get_options())
    if (option->count() > 0 && option->nonpositional()) option->run_callback();
}

}  // namespace

bool isMission(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

namespace {

bool namesMission(const GroundOptions& ground) {
  return !ground.is_cost && isMission(ground.elevation.path);
}

std::filesystem::path folderOf(const GroundOptions& ground) {
  return std::filesystem::path(ground.elevation.path).parent_path();
}

YamlFields missionOf(const GroundOptions& ground) {
  YamlFields fields = YamlFields::file(ground.elevation.path);
  fields.only(namesOf(keysOf("Mission")));
  return fields;
}

// Reads the site of a mission, then assigns all options that the call states.
void readSite(const YamlFields& fields, GroundOptions& ground) {
  ground.mission = ground.elevation.path;
  const std::filesystem::path folder = folderOf(ground);
  const YamlFields maps = fields.fields("maps");
  readMaps(maps, ground, folder);
  ground.rover = fileOrName(fields.word("rover", ""), folder);
  ground.soil = fileOrName(fields.word("soil", ""), folder);
  const std::string model = beside(fields.word("model", ""), folder);
  ground.model = isStated(ground.call, "--soil") ? "" : model;  // a model would take the place of the soil
  ground.soils = beside(fields.word("soils", ""), folder);
  if (fields.has("thresholds")) readThresholds(fields.fields("thresholds"), ground.policy);
  applyCall(ground.call);
  if (maps.has("keep_out")) ground.keep_out.push_back(beside(maps.word("keep_out"), folder));
  if (ground.elevation.path.empty()) ground.elevation.path = ground.map_file;
  if (ground.elevation.path.empty()) maps.refuse("", "defines no map", "give dem: FILE, or map: FILE.ot");
}

}  // namespace

void readMission(GroundOptions& ground) {
  if (namesMission(ground)) readSite(missionOf(ground), ground);
}

void readMission(PlanOptions& options) {
  if (!namesMission(options.ground)) return;
  const std::filesystem::path folder = folderOf(options.ground);
  const YamlFields fields = missionOf(options.ground);
  options.planner = fields.word("planner", "field");
  options.start = place(fields, "start", folder);
  options.goals = places(fields, "goal", folder);
  options.via = places(fields, "via", folder);
  const CLI::Validator heading_range = heading();
  for (const auto& [heading, key] : {std::pair{&options.drive.start_heading_rad, "start_heading_rad"},
                                     std::pair{&options.drive.goal_heading_rad, "goal_heading_rad"}})
    if (fields.has(key)) *heading = ranged(fields, key, heading_range);
  options.drive.no_reverse = !fields.flag("reverse", true);
  if (fields.has("tolerance_m")) options.tolerance_m = ranged(fields, "tolerance_m", notNegative());
  if (fields.has("time_s")) options.time_limit_s = ranged(fields, "time_s", positive());
  options.output = beside(fields.word("output", ""), folder);
  readSite(fields, options.ground);
}

namespace {

// Keys with a value as entries; keys without a value as YAML comments.
std::string keysText(std::span<const terramech::FileKey> keys,
                     const std::map<std::string, nlohmann::json>& values, const std::string& indent) {
  std::string text;
  for (const terramech::FileKey& key : keys) {
    const auto value = values.find(key.name);
    text += value == values.end() || value->second == ""
                ? fmt::format("{}# {}:  # {}\n", indent, key.name, key.meaning)
                : fmt::format("{}{}: {}  # {}\n", indent, key.name, value->second.dump(), key.meaning);
  }
  return text;
}

}  // namespace

std::string missionText(const std::map<std::string, nlohmann::json>& values) {
  std::string text =
      "# talus plan FILE.yaml; paths are relative to this file. Take the # off what you need.\nmaps:\n" +
      keysText(keysOf("Mission: maps"), values, "  ");
  for (const terramech::FileKey& key : keysOf("Mission")) {
    if (std::string(key.name) == "maps") continue;
    if (std::string(key.name) == "thresholds")
      text += "# thresholds:  # uncomment with the keys that you need\n" +
              keysText(keysOf("Mission: thresholds"), {}, "#   ");
    else
      text += keysText({&key, 1}, values, "");
  }
  return text;
}

using terramech::Soil;

namespace {

Soil soilUnder(const YamlFields& fields, const std::string& name, const YamlFields& file,
               const std::string& path) {
  if (fields.isMapping(name)) return terramech::readSoil(fields.fields(name)).mean;
  const std::string word = fields.word(name);
  if (file.has("soils")) {
    const auto own = terramech::loadSoils(path);
    const auto found =
        std::find_if(own.begin(), own.end(), [&](const auto& soil) { return soil.mean.name == word; });
    if (found != own.end()) return found->mean;
  }
  try {
    return terramech::loadSoil(word);
  } catch (const InputError& error) {
    fields.refuse(name, word + ": " + error.parts().reason, error.parts().remedy);
  }
}

double positive(const YamlFields& fields, const std::string& name, double fallback) {
  const double value = fields.number(name, fallback);
  if (!(value > 0.0)) fields.refuse(name, name + " must be > 0", "");
  return value;
}

planner::SoilPatch patchOf(const YamlFields& fields, const YamlFields& file, const std::string& path) {
  fields.only({"x_m", "y_m", "radius_m", "soil"});
  planner::SoilPatch patch{{fields.number("x_m"), fields.number("y_m")}, 0.0, {}};
  if (!std::isfinite(patch.centre.x_m)) fields.refuse("x_m", "x_m is not a finite number", "");
  if (!std::isfinite(patch.centre.y_m)) fields.refuse("y_m", "y_m is not a finite number", "");
  patch.radius_m = positive(fields, "radius_m", 0.0);
  patch.soil = soilUnder(fields, "soil", file, path);
  return patch;
}

void readRandom(const YamlFields& random, const YamlFields& file, const std::string& path,
                planner::Truth& truth) {
  random.only({"spread", "as_believed", "patches", "patch_radius_m", "patch_soil"});
  truth.spread = random.number("spread", 0.0);
  if (!(truth.spread >= 0.0 && truth.spread <= 1.0)) random.refuse("spread", "spread must lie in [0, 1]", "");
  truth.as_believed = random.flag("as_believed", false);
  truth.random_patches = random.integer("patches", 0);
  if (truth.random_patches < 0 || truth.random_patches > 10000)
    random.refuse("patches", "patches must lie in [0, 10000]", "");
  truth.patch_radius_m = positive(random, "patch_radius_m", truth.patch_radius_m);
  if (random.has("patch_soil")) truth.patch_soil = soilUnder(random, "patch_soil", file, path);
}

}  // namespace

planner::Truth readTruth(const std::string& path) {
  const YamlFields file = YamlFields::file(path);
  const std::vector<std::string> more{"patches", "random", "effects", "second_slip"};
  std::vector<std::string> known = more;
  known.insert(known.end(), {"classes", "terrain_classes", "soils"});
  file.only(known);
  planner::Truth truth;
  if (file.has("classes") || file.has("terrain_classes"))
    for (const auto& [number, prior] : terramech::loadTerrainClasses(path, more))
      truth.classes[number] = prior.mean;
  for (const YamlFields& patch : file.list("patches")) truth.patches.push_back(patchOf(patch, file, path));
  truth.patch_soil = terramech::loadSoil("mars_drift");
  truth.effects = terramech::readEffects(file);
  truth.second_slip = file.flag("second_slip", true);
  if (file.has("random")) readRandom(file.fields("random"), file, path, truth);
  return truth;
}

}  // namespace talus::cli
