#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>

#include <talus/common/input_error.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/ground_class.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/planner/plugin/layer_plugin.hpp>
#include <talus/planner/site/site.hpp>
#include <talus/planner/site/stated_costs.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus {
namespace {

// Default soil and rover for the body of the map.
struct Assumed {
  const char* body;
  const char* soil;
  const char* rover;
};
// Upper limit of the slope and step footprint, in diagonals of the rover.
constexpr double kFootprints = 2.0;

constexpr Assumed kAssumed[] = {{"Moon", "lunar_nominal", "lunar_micro"},
                                {"Mars", "mars_blocky", "mer"},
                                {"", "testbed_topsoil", "fido"}};

const Assumed& assumedOn(const maps::ElevationMap& map) {
  const std::string body = map.georeference ? map.georeference->body() : "";
  for (const Assumed& one : kAssumed)
    if (body == one.body) return one;
  return kAssumed[2];
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
std::vector<costmap::GroundClass> groundClasses(const SiteFiles& files, const Assumed& assumed,
                                                const terramech::Rover& rover) {
  std::vector<costmap::GroundClass> classes;
  const bool classes_only = !files.soils.empty() && files.soil.empty() && files.model.empty();
  if (!files.model.empty())
    classes.push_back(modelledGround(files.model, rover));
  else if (!classes_only) {
    const std::string soil = files.soil.empty() ? assumed.soil : files.soil;
    const terramech::SoilPrior prior = terramech::loadSoilPrior(soil);
    requirePeakInContact(prior.mean, soil);
    classes.push_back(costmap::groundClass(0, prior, rover));
  }
  if (files.soils.empty()) return classes;
  for (const auto& [number, prior] : terramech::loadTerrainClasses(files.soils)) {
    requirePeakInContact(prior.mean, fmt::format("{}, class {}", files.soils, number));
    if (number == 0 && !classes.empty()) classes.erase(classes.begin());
    classes.push_back(costmap::groundClass(number, prior, rover));
  }
  return classes;
}

// Runs make(). Rover or soil parameters that are valid but unsuitable for slopes are reported with the file
// that contains them.
template <typename Make>
auto blamingFiles(const SiteFiles& files, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    const std::string_view text = error.what();
    const bool one_soil = text.starts_with("soil ") && files.soils.empty();
    const std::string file = text.starts_with("rover ") ? files.rover : one_soil ? files.soil : "";
    if (!std::ifstream(file).good()) throw;
    throw InputError({file, error.what(), "correct the value"});
  }
}

void warnOfAssumptions(const SiteFiles& files, const Assumed& assumed, const SiteReading& reading) {
  if (files.soil.empty() && files.soils.empty() && files.model.empty())
    reading.tell(std::string("no --soil or --soils: using default soil ") + assumed.soil);
  if (files.rover.empty()) reading.tell(std::string("no --rover: using default rover ") + assumed.rover + "");
}

void warnOfUnseen(const std::vector<costmap::CostLayer>& layers, const costmap::TravelPolicy& policy,
                  const SiteReading& reading) {
  for (const costmap::CostLayer& layer : layers) {
    const auto& values = layer.added_J_per_m.values();
    const auto unseen = std::ranges::count_if(values, [](float v) { return std::isnan(v); });
    if (unseen == 0) continue;
    reading.tell(fmt::format("layer {} has no data in {} of {} cells: they {}", layer.name, unseen,
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

costmap::GroundModel::Parts partsOf(const SiteFiles& files, const maps::ElevationMap& dem,
                                    std::vector<int>& weakest_last, const SiteReading& reading) {
  const Assumed& assumed = assumedOn(dem);
  warnOfAssumptions(files, assumed, reading);
  costmap::GroundModel::Parts parts;
  parts.rover = terramech::loadRover(files.rover.empty() ? assumed.rover : files.rover);
  for (const std::string& line : terramech::slopeAssumptions(parts.rover)) reading.tell(line);
  parts.classes = blamingFiles(files, [&] { return groundClasses(files, assumed, parts.rover); });
  parts.policy = files.policy;
  weakest_last = weakestLast(parts.classes, parts.rover);
  return parts;
}

// Costs that are stated replace rover and soils.
void refuseRover(const SiteFiles& files) {
  costmap::TravelPolicy policy = files.policy;
  policy.allow_unknown = false;
  const std::string stated = files.is_cost ? "--cost" : "--cost-curve";
  if (!files.rover.empty() || !files.soil.empty() || !files.soils.empty() || !files.model.empty() ||
      !files.rocks.empty() || (files.is_cost && (!files.classes.empty() || files.footprint_m > 0.0)) ||
      policy != costmap::TravelPolicy{})
    throw InputError({stated,
                      "stands in place of --rover, --soil, --soils, --model, --rocks and the options of "
                      "thresholds and shape",
                      "remove them, or remove " + stated});
}

// Ground of stated costs, for which the class of greater cost on level ground is the weaker.
costmap::GroundModel::Parts statedParts(const SiteFiles& files, std::vector<int>& weakest_last) {
  refuseRover(files);
  CostCurves curves = readCostCurves(files.cost_curve);
  if (curves.classed != !files.classes.empty())
    throw InputError(
        {files.cost_curve, "a column class and --terrain belong together", "give both, or neither"});
  costmap::GroundModel::Parts parts{.policy = files.policy, .stated = std::move(curves.costs)};
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

std::pair<std::string, std::string> layerNamed(const std::string& given) {
  const std::size_t end = given.find('=');
  const std::string name = given.substr(0, end == std::string::npos ? 0 : end);
  const auto word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (name.empty() || end + 1 == given.size() || !std::ranges::all_of(name, word))
    throw InputError({"--layer " + given, "is not NAME=FILE with a name of letters, digits, - and _",
                      "write --layer shadow=shadow.tif"});
  return {name, given.substr(end + 1)};
}

costmap::CostLayer costLayer(const std::string& given, const maps::ElevationMap& map) {
  const auto [name, path] = layerNamed(given);
  if (path.ends_with(".so")) return planner::layerFrom(path, name, map.grid());
  maps::AddedJoules added = maps::readAddedJoules({path, {}}, map);
  return {.name = name, .added_J_per_m = std::move(added.J_per_m), .unseen_J_per_m = added.highest_J_per_m};
}

// Cells without rock data become unknown ground (NaN); if unknown ground is permitted, such cells
// cost no extra energy.
costmap::CostLayer unseenRocks(const maps::Raster<std::uint8_t>& unseen) {
  costmap::CostLayer layer{.name = "rocks", .added_J_per_m = maps::Raster<float>(unseen.grid())};
  std::ranges::transform(unseen.values(), layer.added_J_per_m.values().begin(), [](std::uint8_t hidden) {
    return hidden != 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  });
  return layer;
}

// Reads the layers beside the elevation map that `layers` contains.
void readLayers(const SiteFiles& files, std::span<const int> weakest_last, costmap::MapLayers& layers,
                const SiteReading& reading) {
  const maps::ElevationMap& map = layers.elevation;
  if (!files.classes.empty())
    layers.classes = maps::readTerrainClasses({files.classes, files.classes_band}, map, weakest_last);
  if (!files.rocks.empty()) {
    maps::RockAbundance rocks = maps::readRockAbundance({files.rocks, files.rocks_band}, map);
    layers.rock_abundance = std::move(rocks.share);
    if (std::ranges::count(rocks.unseen.values(), 0) != std::ssize(rocks.unseen.values()))
      layers.costs.push_back(unseenRocks(rocks.unseen));
  }
  for (const std::string& path : files.keep_out) {
    const auto [mask, notes] = maps::readKeepOut(path, map);
    for (const std::string& note : notes) reading.tell(path + ": " + note);
    if (layers.keep_out.empty()) layers.keep_out = maps::Raster<std::uint8_t>(map.grid());
    for (std::size_t i = 0; i < mask.values().size(); ++i) layers.keep_out.values()[i] |= mask.values()[i];
  }
  for (const std::string& given : files.costs) {
    layers.costs.push_back(costLayer(given, map));
    for (std::size_t i = 0; i + 1 < layers.costs.size(); ++i)
      if (layers.costs[i].name == layers.costs.back().name)
        throw InputError(
            {"--layer " + given, "a layer of that name is given already", "give each its own name"});
  }
}

}  // namespace

std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map) {
  const Assumed& one = assumedOn(map);
  return {one.soil, one.rover};
}

std::vector<InputFile> filesOf(const SiteFiles& site) {
  std::vector<InputFile> files;
  const auto add = [&](const std::string& path, const std::string& role) {
    if (std::ranges::count(files, path, &InputFile::path) == 0) files.push_back({.path = path, .role = role});
  };
  add(site.elevation.path, site.is_cost ? "cost" : "elevation");
  for (const auto& [path, role] : {std::pair{site.classes, "terrain classes"},
                                   {site.rocks, "rocks"},
                                   {site.soils, "soils"},
                                   {site.soil, "soil"},
                                   {site.model, "model"},
                                   {site.rover, "rover"},
                                   {site.cost_curve, "cost curve"}})
    if (std::ifstream(path).good()) add(path, role);
  for (const InputFile& further : site.further) add(further.path, further.role);
  for (const std::string& path : site.keep_out) add(path, "keep-out");
  for (const std::string& given : site.costs) add(layerNamed(given).second, "cost layer");
  return files;
}

std::vector<InputFile> manifestOf(const SiteFiles& files) {
  std::vector<InputFile> named = filesOf(files), read = filesRead();
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

Site readSite(const SiteFiles& files, const SiteReading& reading) {
  const InputRecord record;
  if (files.is_cost) refuseRover(files);
  std::optional<CostRaster> raster;
  if (files.is_cost) raster = readCostRaster(files.elevation, reading);
  costmap::MapLayers layers;
  layers.elevation = raster ? std::move(raster->map) : readMap(files.elevation, reading);
  std::vector<int> weakest_last;
  const bool stated = raster || !files.cost_curve.empty();
  costmap::GroundModel::Parts parts = raster   ? partsOf(*raster, files.policy)
                                      : stated ? statedParts(files, weakest_last)
                                               : partsOf(files, layers.elevation, weakest_last, reading);
  readLayers(files, weakest_last, layers, reading);
  if (raster) layers.classes = std::move(raster->classes);
  const double own_m = std::hypot(parts.rover.wheelbase_m, parts.rover.track_m),
               resolution_m = layers.elevation.grid().resolution_m,
               widest_m = std::max(kFootprints * own_m, 2.0 * resolution_m);
  if (!stated && files.footprint_m > widest_m)
    throw InputError(
        {"--footprint " + fmt::format("{:.6g}", files.footprint_m),
         fmt::format("planes over more than {:.3g} m hide the steps and slopes that rover '{}' meets",
                     widest_m, parts.rover.name),
         "leave it out, or make it smaller"});
  const double nearest_m = std::numbers::sqrt2 * resolution_m,  // 3 x 3 cells
      footprint_m = stated && files.footprint_m == 0.0 ? nearest_m : files.footprint_m;
  layers.elevation.files = manifestOf(files);
  warnOfUnseen(layers.costs, files.policy, reading);
  return {.layers = std::move(layers),
          .ground = blamingFiles(files, [&] { return costmap::GroundModel(std::move(parts)); }),
          .options = {.footprint_radius_m = footprint_m, .threads = reading.threads}};
}

}  // namespace talus
