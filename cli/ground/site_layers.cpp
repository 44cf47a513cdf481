#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <talus/cli/ground/site_layers.hpp>
#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

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

// Category of a cell in its best heading, which depends only on the cost curve and the steepness; cached.
class BestHeading {
 public:
  explicit BestHeading(const costmap::TravelCost& cost) : cost_(cost), known_(cost.curves().size()) {}

  float category(CellCode cell) {
    const double steepness = std::hypot(cell.dzDx(), cell.dzDy());
    const auto step = static_cast<std::size_t>(std::ceil(steepness / kStep - 1e-9));
    auto& curve = known_[cell.curve()];
    if (curve.size() <= step) curve.resize(step + 1, kNoValue);
    if (std::isnan(curve[step])) curve[step] = best(static_cast<double>(step) * kStep, cell.curve());
    return curve[step];
  }

 private:
  static constexpr double kStep = 1.0 / 256.0;

  float best(double steepness, std::uint8_t curve) const {
    constexpr int kHeadings = 48;
    const CellCode cell({.dz_dx = steepness, .dz_dy = 0.0, .curve = curve});
    auto found = terramech::Category::Dangerous;
    for (int k = 0; k <= kHeadings / 2; ++k) {
      const double heading = 2.0 * std::numbers::pi * k / kHeadings;
      const costmap::TravelState state = cost_.detail(cell, {std::cos(heading), std::sin(heading)});
      if (state.refusal == costmap::Refusal::None) found = std::min(found, state.category);
    }
    return static_cast<float>(found);
  }

  const costmap::TravelCost& cost_;
  std::vector<std::vector<float>> known_;  // by curve and step
};

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
  BestHeading best(published->cost());
  layers.push_back(layer(grid, "category_best_heading", "", [&](maps::Cell c) {
    const CellCode code = published->at(c);
    return code.curve() < CellCode::kUnknown ? best.category(code)
                                             : static_cast<float>(beliefs.at(c).category);
  }));
  return layers;
}

}  // namespace talus::cli
