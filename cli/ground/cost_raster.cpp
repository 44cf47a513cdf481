#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <talus/cli/ground/cost_raster.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {
namespace {

// Costs of the cells [1/m]; infinite: impassable; NaN: no data.
maps::ElevationMap costsOf(const MapOptions& options, const Context& context) {
  MapOptions raster = options;
  raster.read.keep_holes = true;
  if (!options.path.ends_with(".yaml")) return readMap(raster, context);
  const auto file = terramech::YamlFields::file(options.path);
  file.only({"image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"});
  const auto origin = file.numbers("origin");
  if (origin.size() != 3 || origin[2] != 0.0)
    file.refuse("origin", "origin must be [x, y, 0]: a turned map is not read",
                "write the map without a yaw");
  if (file.word("mode", "trinary") != "trinary") file.refuse("mode", "mode must be trinary", "write it so");
  raster.path = (std::filesystem::path(options.path).parent_path() / file.word("image")).string();
  raster.read.resolution_m = file.number("resolution");
  maps::ElevationMap map = readMap(raster, context);
  const bool negate = file.integer("negate", 0) != 0;
  const double occupied = file.number("occupied_thresh", 0.65), free = file.number("free_thresh", 0.25);
  for (float& value : map.elevation_m.values()) {
    const double share = (negate ? static_cast<double>(value) : 255.0 - static_cast<double>(value)) / 255.0;
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

CostRaster readCostRaster(const MapOptions& options, const Context& context) {
  CostRaster out{.map = costsOf(options, context), .classes = {}, .costs = {}};
  std::vector<float>& values = out.map.elevation_m.values();
  const std::vector<float> levels = levelsOf(values, options.path);
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

}  // namespace talus::cli
