#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/raster_frame.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/site/site.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/yaml_fields.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus {

void refuseReadOptions(const ElevationFile& file) {
  const maps::ReadOptions& read = file.read;
  const std::pair<const char*, bool> given[] = {
      {"--band", read.band.has_value()},  {"--resolution", read.resolution_m.has_value()},
      {"--window", !file.window.empty()}, {"--nodata", read.nodata.has_value()},
      {"--keep-holes", read.keep_holes},  {"--vertical-scale", read.vertical_scale.has_value()},
      {"--ignore-crs", read.ignore_crs},  {"--max-cells", read.max_cells != maps::ReadOptions{}.max_cells}};
  for (const auto& [name, present] : given)
    if (present)
      throw InputError({file.path, std::string("has a grid of its own, on which ") + name + " has no effect",
                        std::string("remove ") + name});
}

costmap::TraversabilityMap readBuiltMap(const std::string& path, const SiteReading& reading) {
  return costmap::readMap({.name = path, .threads = reading.threads, .georeference = maps::georeferenceOn},
                          reading.watch);
}

maps::ElevationMap readMap(const ElevationFile& file, const SiteReading& reading) {
  if (const auto type = costmap::octomapType(file.path)) {
    refuseReadOptions(file);
    if (*type != "TraversabilityTree")
      return costmap::octomapGround(file.path,
                                    file.below_m.value_or(std::numeric_limits<double>::infinity()));
    if (file.below_m)
      throw InputError({file.path, "--below selects a level of a point cloud, and this is a built map",
                        "give --below to talus costmap"});
    return readBuiltMap(file.path, reading).elevation();
  }
  if (file.below_m)
    throw InputError(
        {file.path, "--below selects a level of an OctoMap, and this is a raster", "remove --below"});
  maps::ReadOptions read = file.read;
  if (!file.window.empty()) read.window = maps::parseWindow(file.window);
  maps::ElevationMap map = maps::readElevation(file.path, read);
  // memory of beliefs, hazards, curves, tiles and their working copies
  constexpr double kBytesPerCell = 40.0;
  requireMemory(kBytesPerCell * static_cast<double>(map.elevation_m.values().size()), file.path);
  for (const std::string& note : map.notes) reading.tell(file.path + ": " + note);
  return map;
}

namespace {

using costmap::TravelCurve;

constexpr double kMostCost = 1e9, kMostGradient = 2.0;
constexpr int kMostClass = 254;

// Costs of one class by gradient across, then by gradient along.
using Rows = std::map<double, std::map<double, double>>;

std::map<int, Rows> readRows(const std::string& path, bool& classed) {
  terramech::CsvReader reader(path);
  const std::vector<std::string> known{"gradient_along", "cost_per_m", "gradient_across", "class"};
  std::vector<std::optional<std::size_t>> columns(known.size());
  for (std::size_t k = 0; k < reader.header().size(); ++k) {
    const auto found = std::ranges::find(known, reader.header()[k]);
    if (found == known.end())
      throw InputError({path + ":1", "has the unknown column '" + reader.header()[k] + "'",
                        "name the columns gradient_along, gradient_across, class, cost_per_m"});
    columns[static_cast<std::size_t>(found - known.begin())] = k;
  }
  if (!columns[0] || !columns[1])
    throw InputError({path + ":1", std::string("has no column ") + known[columns[0] ? 1 : 0],
                      "give gradient_along and cost_per_m"});
  classed = columns[3].has_value();
  std::map<int, Rows> classes;
  for (terramech::CsvRow row; reader.next(row);) {
    const auto refuse = [&](const std::string& reason) {
      throw InputError({fmt::format("{}:{}", path, row.line), reason, "fix the row"});
    };
    if (!row.fault.empty()) refuse(row.fault);
    const auto number = [&](std::size_t k, double low, double high) {
      double value = 0.0;
      if (columns[k] &&
          !(terramech::parseNumber(row.fields[*columns[k]], value) && value >= low && value <= high))
        refuse(fmt::format("{} = '{}', must be {:g} to {:g}", known[k], row.fields[*columns[k]], low, high));
      return value;
    };
    const double along = number(0, -1.0, 1.0), across = number(2, 0.0, kMostGradient),
                 of = number(3, 0.0, kMostClass);
    if (of != std::floor(of)) refuse("class must be a whole number");
    const std::string& text = row.fields[*columns[1]];
    const double cost = text.empty() || text == "inf" ? kInfinity : number(1, 1e-9, kMostCost);
    if (!classes[static_cast<int>(of)][across].emplace(along, cost).second)
      refuse("has the gradients of an earlier row");
  }
  return classes;
}

void requireWhole(const Rows& rows, const std::string& where) {
  if (rows.begin()->first != 0.0 || rows.begin()->second.size() < 2)
    throw InputError(
        {where, "needs two gradients along or more, and gradients across from 0", "add the rows"});
  const std::map<double, double>* last = nullptr;
  for (const auto& [across, row] : rows) {
    if (last != nullptr)
      for (auto a = last->begin(), b = row.begin(); a != last->end() || b != row.end(); ++a, ++b) {
        if (a == last->end() || b == row.end() || a->first != b->first)
          throw InputError(
              {where,
               fmt::format("gradient_across {:g}: has other gradients along than the row before", across),
               "give every pair of gradients"});
        if (b->second < a->second)
          throw InputError(
              {where,
               fmt::format("the cost at gradient_along {:g} falls with gradient_across to {:g}, from "
                           "{:g} to {:g}",
                           b->first, across, a->second, b->second),
               "costs must not decrease across the slope"});
      }
    last = &row;
  }
}

// Linear between the entries of a table, and on from its last two up to `beyond` past an end; else infinite.
double between(const std::map<double, double>& table, double at, double beyond) {
  if (at < table.begin()->first - beyond || at > table.rbegin()->first + beyond) return kInfinity;
  auto high = table.lower_bound(at);
  if (high != table.end() && high->first == at) return high->second;
  if (high == table.begin()) ++high;
  if (high == table.end()) --high;
  const auto low = std::prev(high);
  if (std::isinf(low->second) || std::isinf(high->second)) return kInfinity;
  const double share = (at - low->first) / (high->first - low->first);
  return std::max(low->second + share * (high->second - low->second), 0.0);
}

// A node just beyond a limit that the cost function checks has the value that continues the table, because costs at
// the limit are interpolated to it.
std::shared_ptr<const costmap::TravelStates> statesOf(const Rows& rows, const costmap::StatedCosts& limits,
                                                      std::size_t index) {
  constexpr double kBin = 1.0 / TravelCurve::kBinsPerUnit, kRow = 1.0 / TravelCurve::kRowsPerUnit;
  const bool level = rows.size() == 1;
  const auto cost = [&](const terramech::Gradient& gradient) {
    const double beyond = std::abs(gradient.along) >= limits.max_along ? kBin : 0.0;
    if (level) return between(rows.begin()->second, gradient.along, beyond);
    std::map<double, double> over_across;
    for (const auto& [across, row] : rows) over_across.emplace(across, between(row, gradient.along, beyond));
    return between(over_across, gradient.across, kRow);
  };
  return costmap::statedStates(cost, level ? 0.0 : limits.max_across, static_cast<std::uint8_t>(index));
}

// Costs of the cells [1/m]; infinite: impassable; NaN: no data.
maps::ElevationMap costsOf(const ElevationFile& file, const SiteReading& reading) {
  ElevationFile raster = file;
  raster.read.keep_holes = true;
  if (file.read.vertical_scale)
    throw InputError({"--vertical-scale", "does not apply to costs", "remove it"});
  if (!file.path.ends_with(".yaml")) {
    raster.read.frame_only = true;
    maps::ElevationMap map = readMap(raster, reading);
    // a cell has the greatest cost of all pixels that it overlaps, and no data if one of them has none
    map.elevation_m = maps::readAddedJoules({file.path, file.read.band}, map).J_per_m;
    return map;
  }
  if (file.read.resolution_m)
    throw InputError({"--resolution", "does not apply to a Nav2 map, which states its own", "remove it"});
  const auto yaml = terramech::YamlFields::file(file.path);
  yaml.only({"image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"});
  const auto origin = yaml.numbers("origin");
  if (origin.size() != 3 || origin[2] != 0.0)
    yaml.refuse("origin", "origin must be [x, y, 0]: a turned map is not read",
                "write the map without a yaw");
  if (yaml.word("mode", "trinary") != "trinary") yaml.refuse("mode", "mode must be trinary", "write it so");
  raster.path = (std::filesystem::path(file.path).parent_path() / yaml.word("image")).string();
  raster.read.resolution_m = yaml.number("resolution");
  maps::ElevationMap map = readMap(raster, reading);
  const int negate = yaml.integer("negate", 0);
  const double occupied = yaml.number("occupied_thresh", 0.65), free = yaml.number("free_thresh", 0.25);
  if (!(free >= 0.0 && free <= occupied && occupied <= 1.0) || (negate != 0 && negate != 1))
    yaml.refuse("occupied_thresh",
                "thresholds must be 0 <= free_thresh <= occupied_thresh <= 1, negate 0 or 1",
                "correct the file");
  for (float& value : map.elevation_m.values()) {
    if (value < 0.0F || value > 255.0F)
      throw InputError({raster.path, "has pixels beyond 8 bits", "write an image of 0 to 255"});
    const double share =
        (negate == 1 ? static_cast<double>(value) : 255.0 - static_cast<double>(value)) / 255.0;
    value = static_cast<float>(share > occupied ? kInfinity : share < free ? 1.0 : std::nan(""));
  }
  maps::Grid grid = map.grid();
  grid.south_west = {origin[0], origin[1]};
  map.elevation_m = maps::Raster<float>(grid, std::move(map.elevation_m.values()));
  return map;
}

// Upper ends of at most kRefusedCost levels that hold the costs: the costs themselves, if they are so few.
std::vector<float> levelsOf(const std::vector<float>& values, const std::string& path) {
  std::set<float> distinct;
  float least = std::numeric_limits<float>::infinity(), most = 0.0F;
  for (const float value : values) {
    if (std::isnan(value) || std::isinf(value)) continue;
    if (!(value > 0.0F && value <= 1e9F))
      throw InputError({path,
                        fmt::format("a cost of {:g} a metre, must be above 0 to 1e9, or infinite", value),
                        "scale the raster; no data is unknown ground"});
    least = std::min(least, value), most = std::max(most, value);
    if (distinct.size() <= kRefusedCost) distinct.insert(value);
  }
  if (distinct.empty()) throw InputError({path, "has no cell that may be entered", "check the raster"});
  if (distinct.size() <= kRefusedCost) return {distinct.begin(), distinct.end()};
  const double step =
      std::pow(static_cast<double>(most) / static_cast<double>(least), 1.0 / (kRefusedCost - 1));
  if (step > 1.03)
    throw InputError(
        {path, fmt::format("costs from {:g} to {:g} a metre span more than levels of 3 % hold", least, most),
         "raise the smallest costs, or write inf for the greatest"});
  std::vector<float> levels;
  for (int k = 0; k < kRefusedCost; ++k)
    levels.push_back(static_cast<float>(static_cast<double>(least) * std::pow(step, k)));
  levels.back() = most;
  return levels;
}

}  // namespace

CostCurves readCostCurves(const std::string& path) {
  CostCurves curves;
  const std::map<int, Rows> classes = readRows(path, curves.classed);
  if (classes.empty())
    throw InputError({path, "contains no row", "give a cost for two gradients along or more"});
  costmap::StatedCosts& costs = curves.costs;
  costs.max_along = 0.0;
  double across = 0.0;
  for (const auto& [number, rows] : classes) {
    requireWhole(rows, curves.classed ? fmt::format("{}, class {}", path, number) : path);
    costs.max_along = std::max(
        {costs.max_along, -rows.begin()->second.begin()->first, rows.begin()->second.rbegin()->first});
    across = std::max(across, rows.size() > 1 ? rows.rbegin()->first : kMostGradient);
  }
  costs.max_across = across;
  for (const auto& [number, rows] : classes) {
    costs.states.push_back(statesOf(rows, costs, curves.numbers.size()));
    curves.numbers.push_back(number);
  }
  return curves;
}

CostRaster readCostRaster(const ElevationFile& file, const SiteReading& reading) {
  CostRaster out{.map = costsOf(file, reading), .classes = {}, .costs = {}};
  std::vector<float>& values = out.map.elevation_m.values();
  const std::vector<float> levels = levelsOf(values, file.path);
  out.classes = maps::Raster<std::uint8_t>(out.map.grid(), maps::kNoClass);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const auto level = std::ranges::lower_bound(levels, values[i]) - levels.begin();
    out.classes.values()[i] = std::isinf(values[i]) ? kRefusedCost : static_cast<std::uint8_t>(level);
    values[i] = 0.0F;
  }
  for (const float cost : levels)
    out.costs.states.push_back(
        costmap::statedStates([cost](const terramech::Gradient&) { return static_cast<double>(cost); }, 0.0,
                              static_cast<std::uint8_t>(out.costs.states.size())));
  return out;
}

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
  if (files.rover.empty()) reading.tell(std::string("no --rover: using default rover ") + assumed.rover);
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
    const double mean = terramech::mobilityReference(modelOf(c), rover).drawbar_pull_over_load;
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
