#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/site_layers.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/maps/maps.hpp>

namespace talus::cli {
namespace {

using costmap::CellCode;
using costmap::TraversabilityMap;

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

maps::Layer layer(const maps::Grid& grid, std::string name, std::string unit,
                  const std::function<float(maps::Cell)>& value) {
  maps::Layer out{std::move(name), std::move(unit), maps::Raster<float>(grid)};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) out.values[{column, row}] = value({column, row});
  return out;
}

// Energy [J/m] straight up (sign 1) or down (-1) the slope of the cell; NaN if the direction is refused.
float energyAlong(const costmap::CostGrid& grid, maps::Cell cell, double sign) {
  const CellCode code = grid.at(cell);
  const double steepness = std::hypot(code.dzDx(), code.dzDy());
  const costmap::Direction up =
      steepness > 0.0 ? costmap::Direction{sign * code.dzDx() / steepness, sign * code.dzDy() / steepness}
                      : costmap::Direction{};
  if (!std::isfinite(grid.cost().costPerMetre(code, up))) return kNoValue;
  return grid.cost().detail(code, up).energy_J_per_m;
}

}  // namespace

std::vector<maps::Layer> siteLayers(const TraversabilityMap& map, int threads) {
  const maps::Grid& grid = map.grid();
  maps::TerrainMetrics metrics =
      maps::terrainMetrics(map.elevation().elevation_m, map.surface().footprint(threads));
  const auto published = map.published();
  const auto known = [&](maps::Cell cell, float value) {
    return map.surface().classIndex(cell) < 0 ? kNoValue : value;
  };
  costmap::PlaceBeliefs beliefs(map);
  std::vector<maps::Layer> layers;
  layers.push_back({"elevation", "m", map.elevation().elevation_m});
  layers.push_back(layer(grid, "slope", "rad", [&](maps::Cell c) { return metrics.slope_rad(c); }));
  layers.push_back(layer(grid, "aspect", "rad", [&](maps::Cell c) { return metrics.aspect_rad(c); }));
  layers.push_back({"roughness", "m", std::move(metrics.roughness_m)});
  layers.push_back({"step", "m", std::move(metrics.step_m)});
  layers.push_back(layer(grid, "class", "",
                         [&](maps::Cell c) { return static_cast<float>(map.surface().classNumber(c)); }));
  layers.push_back(
      layer(grid, "category", "", [&](maps::Cell c) { return static_cast<float>(beliefs.at(c).category); }));
  HeadingsOfCells headings(map);
  layers.push_back(
      layer(grid, "allowed_headings", "", [&](maps::Cell c) { return static_cast<float>(headings.at(c)); }));
  layers.push_back(layer(grid, "drawbar_pull_over_load", "",
                         [&](maps::Cell c) { return known(c, beliefs.at(c).pull_mean); }));
  layers.push_back(layer(grid, "drawbar_pull_over_load_std", "",
                         [&](maps::Cell c) { return known(c, beliefs.at(c).pull_std); }));
  layers.push_back(layer(grid, "sinkage_over_radius", "",
                         [&](maps::Cell c) { return known(c, beliefs.at(c).sinkage_mean); }));
  layers.push_back(layer(grid, "energy_per_metre_uphill", "J/m",
                         [&](maps::Cell c) { return energyAlong(*published, c, 1.0); }));
  layers.push_back(layer(grid, "energy_per_metre_downhill", "J/m",
                         [&](maps::Cell c) { return energyAlong(*published, c, -1.0); }));
  return layers;
}

}  // namespace talus::cli
