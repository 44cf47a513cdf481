#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include <talus/costmap/site/surface_patch.hpp>

namespace talus::costmap {

namespace {

constexpr std::array kDigits{10, 11, 12, 13, 15, 16, 18, 20, 22, 25, 28, 30, 35, 40, 45, 50, 60, 70, 80, 90};
constexpr int kPerDecade = static_cast<int>(kDigits.size());
constexpr int kLeastPower = -2;  // step 1 is 10e-2 J/m
constexpr int kLast = 180;       // 9e7 J/m
constexpr double kSame = 1e-7;   // tolerance for sums of floats

std::array<double, kLast + 1> tabulated() {
  std::array<double, kLast + 1> values{};
  for (int step = 1; step <= kLast; ++step) {
    const int power = kLeastPower + (step - 1) / kPerDecade;
    const double digits = kDigits[static_cast<std::size_t>((step - 1) % kPerDecade)];
    values[static_cast<std::size_t>(step)] =
        power < 0 ? digits / std::pow(10.0, -power) : digits * std::pow(10.0, power);
  }
  return values;
}

const std::array<double, kLast + 1>& values() {
  static const std::array<double, kLast + 1> all = tabulated();
  return all;
}

// Returns the sum over the layers without infinite costs.
double sumAt(const std::vector<CostLayer>& layers, std::size_t cell) {
  double sum = 0.0;
  for (const CostLayer& layer : layers) {
    const float added = layer.added_J_per_m.values()[cell];
    if (!std::isinf(added)) sum += static_cast<double>(std::isnan(added) ? layer.unseen_J_per_m : added);
  }
  return sum;
}

}  // namespace

AddedCost::AddedCost(const std::vector<CostLayer>& layers) {
  if (layers.empty()) return;
  const maps::Grid& grid = layers.front().added_J_per_m.grid();
  steps_ = maps::Raster<std::uint8_t>(grid, 0);
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const double sum = sumAt(layers, cell);
    steps_.values()[cell] =
        static_cast<std::uint8_t>(std::ranges::lower_bound(values(), sum * (1.0 - kSame)) - values().begin());
  }
}

double AddedCost::J_per_m(int step) noexcept {
  return values()[static_cast<std::size_t>(std::min(step, kLast))];
}

namespace {

constexpr double kSameCells = 1e-6;  // tolerance for the rounding of coordinates [cells]
constexpr double kMostKeys = 32767.0;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("SurfacePatch: " + what);
}

std::string text(const maps::Grid& grid) {
  std::ostringstream out;
  out << grid.width << " x " << grid.height << " cells of " << grid.resolution_m << " m from ("
      << grid.south_west.x_m << ", " << grid.south_west.y_m << ") m";
  return out.str();
}

std::string text(const maps::Grid& grid, std::size_t index) {
  const maps::Cell cell{static_cast<int>(index % static_cast<std::size_t>(grid.width)),
                        static_cast<int>(index / static_cast<std::size_t>(grid.width))};
  const maps::Point at = grid.centre(cell);
  std::ostringstream out;
  out << "at (" << at.x_m << ", " << at.y_m << ") m, column " << cell.column << ", row " << cell.row;
  return out.str();
}

template <typename T>
void requireSame(std::optional<maps::Grid>& grid, const maps::Raster<T>& layer, const char* name) {
  if (layer.empty()) return;
  if (!grid)
    grid = layer.grid();
  else if (layer.grid() != *grid)
    refuse(std::string(name) + " lies on " + text(layer.grid()) + ", the layers before it on " + text(*grid) +
           "; give all layers of a patch on one grid");
}

maps::Grid gridOf(const SurfacePatch& patch) {
  std::optional<maps::Grid> grid;
  requireSame(grid, patch.elevation_m, "elevation_m");
  requireSame(grid, patch.rock_abundance, "rock_abundance");
  requireSame(grid, patch.classes, "classes");
  requireSame(grid, patch.keep_out, "keep_out");
  if (!grid || grid->width < 1 || grid->height < 1)
    refuse("no layer has a cell; give heights, rocks, classes or keep-out");
  return *grid;
}

// First column or row of a patch in a map.
int firstOf(double patch_m, double map_m, double resolution_m, const maps::Grid& patch,
            const maps::Grid& map) {
  const double first = (patch_m - map_m) / resolution_m;
  if (!(std::abs(first) <= 1e9))
    refuse(text(patch) + " lies off the map of " + text(map) + "; cut it to the map");
  if (std::abs(first - std::round(first)) > kSameCells)
    refuse(text(patch) + " lies between the cells of the map of " + text(map) +
           "; resample it onto the map's cells");
  return static_cast<int>(std::round(first));
}

void requireHeights(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys, bool any_before) {
  const double reach_m = kMostKeys * keys.grid().resolution_m;
  std::optional<double> base_m;
  if (any_before) base_m = keys.baseElevation_m();
  for (std::size_t i = 0; i < elevation_m.values().size(); ++i) {
    const auto height_m = static_cast<double>(elevation_m.values()[i]);
    if (std::isnan(height_m)) continue;
    if (!base_m && std::abs(height_m) <= kHighest_m) base_m = height_m;
    if (base_m && std::abs(height_m - *base_m) <= reach_m) continue;
    std::ostringstream what;
    what << "elevation_m = " << height_m << ' ' << text(elevation_m.grid(), i) << ", must be NaN or within "
         << (base_m ? reach_m : kHighest_m) << " m of " << base_m.value_or(0.0) << " m";
    refuse(what.str());
  }
}

struct Bounds {
  double low, high;
};

// Returns the text of the first value that is neither NaN nor within a range, with its position and the valid
// range; nullopt if all are valid.
std::optional<std::string> impossible(const char* layer, const maps::Raster<float>& raster,
                                      const Bounds& range) {
  for (std::size_t i = 0; i < raster.values().size(); ++i) {
    const auto value = static_cast<double>(raster.values()[i]);
    if (std::isnan(value) || (value >= range.low && value <= range.high)) continue;
    std::ostringstream what;
    what << layer << " = " << value << ' ' << text(raster.grid(), i) << ", must be NaN or " << range.low
         << " to " << range.high;
    return what.str();
  }
  return std::nullopt;
}

std::optional<std::string> impossibleShare(const maps::Raster<float>& rock_abundance) {
  return impossible("rock_abundance", rock_abundance, {0.0, 1.0});
}

bool isEmpty(const SurfacePatch& patch) {
  for (const maps::Raster<float>* layer : {&patch.elevation_m, &patch.rock_abundance})
    for (const float value : layer->values())
      if (!std::isnan(value)) return false;
  for (const std::uint8_t number : patch.classes.values())
    if (number != GroundSite::kNoClass) return false;
  return patch.keep_out.empty();
}

}  // namespace

maps::CellBox placeOf(const SurfacePatch& patch, const GroundSite& site, bool any_height) {
  const maps::Grid grid = gridOf(patch), &map = site.grid();
  if (!(std::abs(grid.resolution_m - map.resolution_m) * std::max(grid.width, grid.height) <=
        kSameCells * map.resolution_m)) {
    std::ostringstream what;
    what << "resolution_m = " << grid.resolution_m << ", must be the map's " << map.resolution_m
         << "; resample it onto the map's cells";
    refuse(what.str());
  }
  const maps::Cell first{firstOf(grid.south_west.x_m, map.south_west.x_m, map.resolution_m, grid, map),
                         firstOf(grid.south_west.y_m, map.south_west.y_m, map.resolution_m, grid, map)};
  const maps::CellBox box{first, {first.column + grid.width - 1, first.row + grid.height - 1}};
  if (!map.contains(box.first) || !map.contains(box.last))
    refuse(text(grid) + " reaches off the map of " + text(map) + "; cut it to the map");
  if (!patch.classes.empty() && site.classes.empty())
    refuse("classes, but the map has none; build it with a class raster");
  if (isEmpty(patch)) refuse("all of " + text(grid) + " is NaN or without a class; nothing was observed");
  requireHeights(patch.elevation_m, site.keys, any_height);
  if (const auto what = impossibleShare(patch.rock_abundance)) refuse(*what);
  return box;
}

void requirePossible(const MapLayers& layers) {
  const maps::Grid& grid = layers.elevation.grid();
  if (!(grid.resolution_m >= 1e-3 && grid.resolution_m <= 1e6 && std::isfinite(grid.south_west.x_m) &&
        std::isfinite(grid.south_west.y_m)))
    throw std::invalid_argument("TraversabilityMap: " + text(grid) +
                                ", must be finite, of 0.001 m to 1000 km");
  auto what = impossible("elevation_m", layers.elevation.elevation_m, {-kHighest_m, kHighest_m});
  if (!what) what = impossibleShare(layers.rock_abundance);
  if (what) throw std::invalid_argument("TraversabilityMap: " + *what);
}

double middleElevation(const maps::Raster<float>& elevation_m) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float e : elevation_m.values())
    if (!std::isnan(e)) {
      low = std::min(low, e);
      high = std::max(high, e);
    }
  return low <= high ? 0.5 * (static_cast<double>(low) + static_cast<double>(high)) : 0.0;
}

}  // namespace talus::costmap
