#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/help_format.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/ground/stated_costs.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::cli {
namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Default soil and rover for the body of the map.
struct Assumed {
  const char* body;
  const char* soil;
  const char* rover;
};
// Upper limit of the slope and step footprint, in diagonals of the rover.
constexpr double kFootprints = 2.0;
constexpr float kSameHeight_m = 0.01F;

constexpr Assumed kAssumed[] = {{"Moon", "lunar_nominal", "lunar_micro"},
                                {"Mars", "mars_blocky", "mer"},
                                {"", "testbed_topsoil", "fido"}};

const Assumed& assumedOn(const maps::ElevationMap& map) {
  const std::string body = map.georeference ? map.georeference->body() : "";
  for (const Assumed& one : kAssumed)
    if (body == one.body) return one;
  return kAssumed[2];
}

bool isBeliefMap(const std::string& path) {
  return costmap::octomapType(path) == "TraversabilityTree";
}

void addPolicy(CLI::App& command, costmap::TravelPolicy& policy) {
  command.add_flag("--no-marginal{false}", policy.allow_marginal, "exclude marginal cells");
  command.add_flag("--allow-dangerous", policy.allow_dangerous,
                   "allow dangerous cells where the drawbar pull is sufficient");
  command.add_flag("--allow-unknown", policy.allow_unknown,
                   "drive over cells without data, at the slope between the heights beside them");
  command
      .add_option_function<double>(
          "--slope-uncertainty-deg", [&policy](double deg) { policy.slope_margin_rad = deg * kDegree; },
          "slope uncertainty on either side of a category threshold (default: 5)")
      ->type_name("DEG");
  command.add_option("--time-weight", policy.time_weight_W, "cost of time, joules per second")
      ->type_name("W")
      ->capture_default_str();
  command
      .add_option("--entrapment", policy.entrapment,
                  "fraction of the places with too weak soil that immobilise a rover that monitors its slip")
      ->type_name("FRACTION")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_flag("--unmonitored", policy.unmonitored,
                   "slip is not monitored: every place with too weak soil immobilises the rover");
  command
      .add_option("--pose-error", policy.pose_error_m,
                  "position error of the rover: soil is evaluated that far beyond the wheels")
      ->type_name("METRES")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--risk-weight", policy.risk_weight_J, "cost of losing the rover, joules")
      ->type_name("J")
      ->capture_default_str();
  groupOptions(command, "Cost and thresholds");
}

// Maps evaluate soils at slips from -1 (braked downhill) to 1. At each slip the stress peak theta_m = (c1 +
// c2 slip) theta_1 must lie in the contact.
void requirePeakInContact(const terramech::Soil& soil, const std::string& file) {
  for (const double slip : {-1.0, 1.0})
    if (const double peak = soil.c1 + soil.c2 * slip; !(peak >= 0.0 && peak <= 1.0))
      throw InputError(
          {file,
           fmt::format("soil '{}': c1 = {:.6g} and c2 = {:.6g} put the stress peak at {:.6g} of the "
                       "contact at slip {:g}, must be 0 to 1",
                       soil.name, soil.c1, soil.c2, peak, slip),
           "lower the magnitude of c2, or leave both out"});
}

costmap::GroundClass modelledGround(const std::string& path, const terramech::Rover& rover) {
  const terramech::ModelFile file = terramech::loadModel(path);
  if (!file.soil_given) throw InputError({path, "defines no soil", "fit one first: talus trace --model-out"});
  requirePeakInContact(file.model.soil, path);
  try {
    return costmap::groundClass(0, file.model, rover);
  } catch (const std::invalid_argument& e) {
    throw InputError({path, e.what(), ""});
  }
}

// Class of ground without a class number, then the classes of the classes file.
std::vector<costmap::GroundClass> groundClasses(const GroundOptions& options, const Assumed& assumed,
                                                const terramech::Rover& rover) {
  std::vector<costmap::GroundClass> classes;
  const bool classes_only = !options.soils.empty() && options.soil.empty() && options.model.empty();
  if (!options.model.empty())
    classes.push_back(modelledGround(options.model, rover));
  else if (!classes_only) {
    const std::string soil = options.soil.empty() ? assumed.soil : options.soil;
    const terramech::SoilPrior prior = terramech::loadSoilPrior(soil);
    requirePeakInContact(prior.mean, soil);
    classes.push_back(costmap::groundClass(0, prior, rover));
  }
  if (options.soils.empty()) return classes;
  for (const auto& [number, prior] : terramech::loadTerrainClasses(options.soils)) {
    requirePeakInContact(prior.mean, fmt::format("{}, class {}", options.soils, number));
    if (number == 0 && !classes.empty()) classes.erase(classes.begin());
    classes.push_back(costmap::groundClass(number, prior, rover));
  }
  return classes;
}

// Runs make(). Rover or soil parameters that are valid but unsuitable for slopes are reported with the file
// that contains them.
template <typename Make>
auto blamingFiles(const GroundOptions& options, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    const std::string_view text = error.what();
    const bool one_soil = text.starts_with("soil ") && options.soils.empty();
    const std::string file = text.starts_with("rover ") ? options.rover : one_soil ? options.soil : "";
    if (!std::ifstream(file).good()) throw;
    throw InputError({file, error.what(), "correct the value"});
  }
}

// Returns true if no elevation map is given in addition to the built map.
bool isBuiltAlone(const GroundOptions& options, const std::string& path) {
  return options.dem.path.empty() || options.dem.path == path || isBeliefMap(options.dem.path);
}

auto fieldsOf(const costmap::TravelPolicy& p) {
  return std::tie(p.allow_marginal, p.allow_dangerous, p.allow_unknown, p.slope_margin_rad,
                  p.sinkage_threshold, p.sinkage_critical, p.max_immobilisation, p.pose_error_m,
                  p.time_weight_W, p.entrapment, p.unmonitored_entrapment, p.unmonitored, p.risk_weight_J,
                  p.correlation_length_m);
}

// A built map has its own grid, layers, soils, rover and policy; conflicting options of the call are refused.
// With an additional elevation map, options may repeat how that map is read and how the built map was built.
void checkAgainstMap(const GroundOptions& options, const std::string& path, const Context& context) {
  const bool alone = isBuiltAlone(options, path);
  if (alone) refuseReadOptions(options.dem);
  const std::tuple<std::string, bool, bool> given[] = {
      {"--keep-out", true, !options.layers.keep_out.empty()},
      {"--layer", true, !options.layers.costs.empty()},
      {"an option of thresholds, weights and risk", true,
       fieldsOf(options.policy) != fieldsOf(costmap::TravelPolicy{})},
      {"--below", alone, alone && options.dem.below_m.has_value()},
      {"--terrain", alone, !options.layers.terrain.empty() || options.layers.terrain_band},
      {"--rocks", alone, !options.layers.rocks.empty() || options.layers.rocks_band},
      {"--soils", alone, !options.soils.empty()},
      {"--soil", alone, !options.soil.empty()},
      {"--model", alone, !options.model.empty()},
      {"--footprint", alone, options.footprint_m != 0.0}};
  for (const auto& [name, refused, present] : given) {
    if (present && refused)
      throw InputError({path, "is a built map, on which " + name + " has no effect",
                        "give " + name + " to talus costmap, or plan on the elevation map"});
    if (present) context.warn(name + " has no effect: " + path + " has its own");
  }
}

// Compares the rover of the call with the rover of the map: slopes, costs and shapes are valid for one rover
// only.
void checkSameRover(const GroundOptions& options, const terramech::Rover& own, const std::string& path) {
  if (options.rover.empty()) return;
  const auto fields = [](const terramech::Rover& r) {
    return std::tie(r.mass_kg, r.gravity_m_s2, r.wheel_count, r.wheel.radius_m, r.wheel.width_m,
                    r.wheel.grouser_height_m, r.wheel.grouser_count, r.wheel.lug_thrust, r.wheelbase_m,
                    r.track_m, r.clearance_m, r.centre_of_mass_height_m, r.centre_of_mass_ahead_m,
                    r.centre_of_mass_left_m, r.max_pitch_rad, r.max_roll_rad, r.max_torque_Nm,
                    r.max_speed_mps, r.turning_radius_m, r.hotel_power_W, r.steering);
  };
  if (fields(terramech::loadRover(options.rover)) != fields(own))
    throw InputError({path, "was built for rover '" + own.name + "', not for --rover " + options.rover,
                      "build a map for that one with talus costmap"});
}

// An elevation map given beside a built map identifies the site: routes planned on other slopes would be
// wrong.
void checkSameSite(const maps::ElevationMap& dem, const costmap::TraversabilityMap& map,
                   const std::string& path) {
  const maps::Grid &a = dem.grid(), &b = map.grid();
  const auto refuse = [&](const std::string& reason) {
    throw InputError({path, "was not built from " + dem.source + ": " + reason,
                      "name the elevation map that it was built from, or none but the map"});
  };
  const double near = 1e-6 * b.resolution_m;
  if (a.width != b.width || a.height != b.height || std::abs(a.resolution_m - b.resolution_m) > near ||
      std::abs(a.south_west.x_m - b.south_west.x_m) > near ||
      std::abs(a.south_west.y_m - b.south_west.y_m) > near)
    refuse(fmt::format("{} x {} cells of {:.6g} m against {} x {} of {:.6g} m, or another place", a.width,
                       a.height, a.resolution_m, b.width, b.height, b.resolution_m));
  const auto &heights = dem.elevation_m.values(), &own = map.elevation().elevation_m.values();
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (std::isnan(heights[i]) != std::isnan(own[i]) || std::abs(heights[i] - own[i]) > kSameHeight_m)
      refuse(fmt::format("elevation {:.6g} m against {:.6g} m in cell {}", heights[i], own[i], i));
}

// Elevation map given in addition to a built map; nothing, with a warning, if there is no such file.
std::optional<maps::ElevationMap> siteOf(const GroundOptions& options, const std::string& path,
                                         const Context& context) {
  if (isBuiltAlone(options, path)) return std::nullopt;
  if (std::filesystem::exists(options.dem.path)) return readMap(options.dem, context);
  context.warn(path + " is not compared with the elevation map: " + options.dem.path + ": no such file");
  return std::nullopt;
}

void warnOfRover(const terramech::Rover& rover, const Context& context) {
  for (const std::string& assumed : terramech::slopeAssumptions(rover)) context.warn(assumed);
}

// All files read, those that the options name first, with their roles. A file that an option names and that was not
// read is unused.
std::vector<InputFile> manifestOf(const GroundOptions& options) {
  std::vector<InputFile> named = filesOf(options), read = filesRead();
  for (InputFile& file : named) {
    const auto found = std::ranges::find(read, file.path, &InputFile::path);
    file.used = found != read.end();
    if (!file.used) continue;
    std::tie(file.size, file.sha256) = std::tie(found->size, found->sha256);
    read.erase(found);
  }
  named.insert(named.end(), read.begin(), read.end());
  return named;
}

Ground fromMapFile(const GroundOptions& options, const std::string& path, const Context& context) {
  checkAgainstMap(options, path, context);
  const auto begin = Clock::now();
  const InputRecord record;
  Ground ground{readBuiltMap(path, context), {}};
  checkSameRover(options, ground.map.model().rover(), path);
  if (const auto dem = siteOf(options, path, context)) checkSameSite(*dem, ground.map, path);
  ground.files = manifestOf(options);
  const auto& before = ground.map.elevation().files;
  ground.files.insert(ground.files.end(), before.begin(), before.end());
  ground.load_s = since_s(begin);
  warnOfRover(ground.map.model().rover(), context);
  return ground;
}

void warnOfAssumptions(const GroundOptions& options, const Assumed& assumed, const Context& context) {
  if (options.soil.empty() && options.soils.empty() && options.model.empty())
    context.warn(std::string("no --soil or --soils: using default soil ") + assumed.soil);
  if (options.rover.empty())
    context.warn(std::string("no --rover: using default rover ") + assumed.rover + "");
}

void warnOfUnseen(const std::vector<costmap::CostLayer>& layers, const costmap::TravelPolicy& policy,
                  const Context& context) {
  for (const costmap::CostLayer& layer : layers) {
    const auto& values = layer.added_J_per_m.values();
    const auto unseen = std::ranges::count_if(values, [](float v) { return std::isnan(v); });
    if (unseen == 0) continue;
    context.warn(fmt::format("layer {} has no data in {} of {} cells: they {}", layer.name, unseen,
                             values.size(),
                             !policy.allow_unknown ? "count as unknown and are excluded"
                             : layer.unseen_J_per_m > 0.0F
                                 ? fmt::format("cost {:.6g} J/m more, as the highest", layer.unseen_J_per_m)
                                 : "cost nothing more"));
  }
}

// Class numbers from the strongest to the weakest ground, ordered by mean drawbar pull minus two standard
// deviations (exceeded at 39 of 40 places).
std::vector<int> weakestLast(const std::vector<costmap::GroundClass>& classes,
                             const terramech::Rover& rover) {
  std::vector<std::pair<double, int>> by_pull;
  for (const costmap::GroundClass& c : classes) {
    const double mean = costmap::referenceOf(c, rover).drawbar_pull_over_load;
    by_pull.emplace_back(2.0 * std::hypot(c.pull_std, c.mean_std) - mean, c.number);
  }
  std::ranges::sort(by_pull);
  std::vector<int> numbers;
  for (const auto& [weakness, number] : by_pull) numbers.push_back(number);
  return numbers;
}

costmap::GroundModel::Parts partsOf(const GroundOptions& options, const maps::ElevationMap& dem,
                                    std::vector<int>& weakest_last, const Context& context) {
  const Assumed& assumed = assumedOn(dem);
  warnOfAssumptions(options, assumed, context);
  costmap::GroundModel::Parts parts;
  parts.rover = terramech::loadRover(options.rover.empty() ? assumed.rover : options.rover);
  warnOfRover(parts.rover, context);
  parts.classes = blamingFiles(options, [&] { return groundClasses(options, assumed, parts.rover); });
  parts.policy = options.policy;
  weakest_last = weakestLast(parts.classes, parts.rover);
  return parts;
}

// Costs that are stated replace rover and soils.
void refuseRover(const GroundOptions& options) {
  costmap::TravelPolicy policy = options.policy;
  policy.allow_unknown = false;
  const std::string stated = options.is_cost ? "--cost" : "--cost-curve";
  if (!options.rover.empty() || !options.soil.empty() || !options.soils.empty() || !options.model.empty() ||
      !options.layers.rocks.empty() ||
      (options.is_cost && (!options.layers.terrain.empty() || options.footprint_m > 0.0)) ||
      fieldsOf(policy) != fieldsOf(costmap::TravelPolicy{}))
    throw InputError({stated,
                      "stands in place of --rover, --soil, --soils, --model, --rocks and the options of "
                      "thresholds and shape",
                      "remove them, or remove " + stated});
}

// Ground of stated costs, for which the class of greater cost on level ground is the weaker.
costmap::GroundModel::Parts statedParts(const GroundOptions& options, std::vector<int>& weakest_last) {
  refuseRover(options);
  CostCurves curves = readCostCurves(options.cost_curve);
  if (curves.classed != !options.layers.terrain.empty())
    throw InputError(
        {options.cost_curve, "a column class and --terrain belong together", "give both, or neither"});
  costmap::GroundModel::Parts parts{.policy = options.policy, .stated = std::move(curves.costs)};
  std::vector<std::pair<float, int>> by_cost;
  for (std::size_t i = 0; i < curves.numbers.size(); ++i) {
    parts.classes.push_back({.number = curves.numbers[i]});
    by_cost.emplace_back(parts.stated->states[i]->at(0, costmap::TravelCurve::kBins / 2).energy_J_per_m,
                         curves.numbers[i]);
  }
  std::ranges::sort(by_cost);
  for (const auto& [cost, number] : by_cost) weakest_last.push_back(number);
  return parts;
}

costmap::GroundModel::Parts partsOf(const CostRaster& raster, const costmap::TravelPolicy& policy) {
  costmap::GroundModel::Parts parts{.policy = policy, .stated = raster.costs};
  for (int k = 0; k < static_cast<int>(raster.costs.states.size()); ++k)
    parts.classes.push_back({.number = k});
  return parts;
}

}  // namespace

std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map) {
  const Assumed& one = assumedOn(map);
  return {one.soil, one.rover};
}

void addGroundOptions(CLI::App& command, GroundOptions& options) {
  addMapOptions(command, options.dem);
  command.add_option("--map", options.map_file, "traversability map from `talus costmap` or `talus update`")
      ->type_name("MAP.ot");
  groupOptions(command, "Elevation map");
  addGroundChoices(command, options);
}

void addGroundChoices(CLI::App& command, GroundOptions& options) {
  addLayerOptions(command, options.layers);
  command.add_option("--soils", options.soils, "soil of each terrain class")->type_name("FILE");
  auto* soil =
      command.add_option("--soil", options.soil, "soil of cells without a class: a library name or a file")
          ->type_name("SOIL");
  command
      .add_option("--model", options.model,
                  "refined model of cells without a class, from `talus trace`, instead of --soil")
      ->type_name("M.yaml")
      ->excludes(soil);
  command.add_option("--rover", options.rover, "rover: a library name or a file")->type_name("ROVER");
  command
      .add_option("--footprint", options.footprint_m,
                  "radius over which slopes are computed (default: the rover's)")
      ->type_name("METRES")
      ->check(notNegative());
  groupOptions(command, "Soil and rover");
  addPolicy(command, options.policy);
}

void addCostCurve(CLI::App& command, GroundOptions& options) {
  command
      .add_option("--cost-curve", options.cost_curve,
                  "cost a metre over gradient_along and gradient_across, in place of rover and soil")
      ->type_name("FILE.csv");
  command
      .add_flag("--cost", options.is_cost,
                "the map is a raster of costs a metre, or the YAML file of a Nav2 map, in place of heights, "
                "rover and soil")
      ->excludes("--cost-curve");
}

std::vector<InputFile> filesOf(const GroundOptions& options) {
  std::vector<InputFile> files;
  const auto add = [&](const std::string& path, const char* role) {
    if (std::ranges::count(files, path, &InputFile::path) == 0) files.push_back({.path = path, .role = role});
  };
  add(options.dem.path, options.is_cost ? "cost" : "elevation");
  const LayerOptions& layers = options.layers;
  for (const auto& [path, role] : {std::pair{options.map_file, "map"},
                                   {layers.terrain, "terrain classes"},
                                   {layers.rocks, "rocks"},
                                   {options.soils, "soils"},
                                   {options.soil, "soil"},
                                   {options.model, "model"},
                                   {options.rover, "rover"},
                                   {options.cost_curve, "cost curve"},
                                   {options.mission, "mission"}})
    if (std::ifstream(path).good()) add(path, role);
  for (const std::string& path : layers.keep_out) add(path, "keep-out");
  for (const std::string& given : layers.costs) add(layerNamed(given).second, "cost layer");
  return files;
}

Ground readGround(const GroundOptions& options, const Context& context) {
  if (!options.cost_curve.empty() && (!options.map_file.empty() || isBeliefMap(options.dem.path)))
    throw InputError({"--cost-curve " + options.cost_curve,
                      "has no effect on a built map, which has its own costs", "plan on the elevation map"});
  if (!options.map_file.empty()) return fromMapFile(options, options.map_file, context);
  if (isBeliefMap(options.dem.path)) return fromMapFile(options, options.dem.path, context);
  auto begin = Clock::now();
  const InputRecord record;
  if (options.is_cost) refuseRover(options);
  std::optional<CostRaster> raster;
  if (options.is_cost) raster = readCostRaster(options.dem, context);
  maps::ElevationMap dem = raster ? std::move(raster->map) : readMap(options.dem, context);
  std::vector<int> weakest_last;
  const bool stated = raster || !options.cost_curve.empty();
  costmap::GroundModel::Parts parts = raster   ? partsOf(*raster, options.policy)
                                      : stated ? statedParts(options, weakest_last)
                                               : partsOf(options, dem, weakest_last, context);
  Layers layers = readLayers(options.layers, dem, weakest_last);
  if (raster) layers.classes = std::move(raster->classes);
  for (const std::string& note : layers.notes) context.warn(note);
  const double load_s = since_s(begin);
  begin = Clock::now();
  const double own_m = std::hypot(parts.rover.wheelbase_m, parts.rover.track_m),
               widest_m = std::max(kFootprints * own_m, 2.0 * dem.grid().resolution_m);
  if (!stated && options.footprint_m > widest_m)
    throw InputError(
        {"--footprint " + fmt::format("{:.6g}", options.footprint_m),
         fmt::format("planes over more than {:.3g} m hide the steps and slopes that rover '{}' meets",
                     widest_m, parts.rover.name),
         "leave it out, or make it smaller"});
  const double nearest_m = std::numbers::sqrt2 * dem.grid().resolution_m,  // 3 x 3 cells
      footprint_m = stated && options.footprint_m == 0.0 ? nearest_m : options.footprint_m;
  std::vector<InputFile> files = manifestOf(options);
  dem.files = files;
  costmap::MapLayers content{std::move(dem),
                             std::move(layers.classes),
                             std::move(layers.rock_abundance),
                             std::move(layers.keep_out),
                             {},
                             std::move(layers.costs)};
  warnOfUnseen(content.costs, options.policy, context);
  costmap::TraversabilityMap map = blamingFiles(options, [&] {
    return costmap::TraversabilityMap(
        std::move(content), std::make_shared<costmap::GroundModel>(std::move(parts)),
        {.footprint_radius_m = footprint_m, .threads = context.workers()}, context.watch("costmap"));
  });
  return {std::move(map), std::move(files), load_s, since_s(begin)};
}

}  // namespace talus::cli
