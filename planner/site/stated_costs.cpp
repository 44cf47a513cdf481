#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/planner/site/stated_costs.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/field_text.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus {
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

}  // namespace talus
