#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/published_map.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/site/surface_patch.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/rock_hazard.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

// The surface of a map, built at once and window by window: shape, layers, and what the rover keeps clear of.
namespace talus::costmap {
namespace {

std::vector<std::shared_ptr<CostTile>> emptyTiles(const maps::Grid& grid) {
  const auto across = [](int cells) {
    return static_cast<std::size_t>((cells + CostTile::kSide - 1) / CostTile::kSide);
  };
  std::vector<std::shared_ptr<CostTile>> tiles(across(grid.width) * across(grid.height));
  for (auto& tile : tiles) tile = std::make_shared<CostTile>();
  return tiles;
}

Hazard without(Hazard set, Hazard one) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(set) & ~static_cast<unsigned>(one));
}

Hazard with(Hazard set, Hazard one, bool there) noexcept {
  return there ? set | one : without(set, one);
}

CellCode flatCode(const GroundShape& shape) {
  return CellCode({.dz_dx = static_cast<double>(shape.dz_dx), .dz_dy = static_cast<double>(shape.dz_dy)});
}

// Calls take(cell of the map, value of the patch) for each cell of a layer, if there is one.
template <typename T, typename Take>
void forEachGiven(const maps::Raster<T>& layer, const maps::CellBox& window, const Take& take) {
  if (layer.empty()) return;
  forEachCell(window, [&](maps::Cell cell) {
    take(cell, layer[{cell.column - window.first.column, cell.row - window.first.row}]);
  });
}

}  // namespace

Hazard TraversabilityMap::rocksOn(float abundance) const {
  const RockCrossing crossing{.diameter_m = limits_.rock_diameter_m, .area_m2 = limits_.rock_area_m2};
  const bool refused = rockHazard(static_cast<double>(abundance), crossing) > limits_.max_rock_probability;
  return refused ? Hazard::Rocks : Hazard::None;
}

Hazard TraversabilityMap::spreading() const noexcept {
  return site_->model->parts().policy.allow_unknown ? Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks
                                                    : kKeptClearOf;
}

Hazard TraversabilityMap::layerHazards(maps::Cell cell) const {
  Hazard found = given_.empty() ? Hazard::None : given_[cell];
  if (std::isnan(site_->elevation.elevation_m[cell])) found |= Hazard::Unknown;
  if (!site_->classes.empty()) {
    const std::uint8_t number = site_->classes[cell];
    if (number == GroundSite::kNoClass)
      found |= Hazard::Unknown;
    else if (site_->model->classIndex(number) < 0)
      found |= Hazard::Obstacle;
  }
  for (const CostLayer& layer : site_->costs) {
    const float added = layer.added_J_per_m[cell];
    if (std::isinf(added)) found |= Hazard::KeepOut;
    if (std::isnan(added) && !site_->model->parts().policy.allow_unknown) found |= Hazard::Unknown;
  }
  return found;
}

TileTable TraversabilityMap::measure(const MapLayers& layers, const ProgressMonitor& watch) {
  if (!layers.declared.empty()) given_ = layers.declared;
  takeHazards({.elevation_m = {},
               .rock_abundance = layers.rock_abundance,
               .classes = {},
               .keep_out = layers.keep_out},
              allOf(grid()));
  const std::vector<std::shared_ptr<CostTile>> tiles = emptyTiles(grid());
  const int tile_columns = (grid().width + CostTile::kSide - 1) / CostTile::kSide;
  const auto slot = [&](maps::Cell c) -> CellCode& {
    auto& tile = *tiles[static_cast<std::size_t>((c.row >> 6) * tile_columns + (c.column >> 6))];
    return tile.cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  };
  const SurfaceShape shapes(footprint(threads_));
  shapes.measure(
      site_->elevation.elevation_m, allOf(grid()), limits_,
      [&](maps::Cell cell, const GroundShape& shape, Hazard found) {
        hazards_[cell] = found | layerHazards(cell);
        slot(cell) = flatCode(shape);
      },
      watch);
  inflate(hazards_, limits_, spreading());
  forEachCell(allOf(grid()), [&](maps::Cell cell) { slot(cell) = coded(cell, slot(cell)); });
  return TileTable(std::vector<TileTable::Shared>(tiles.begin(), tiles.end()));
}

void TraversabilityMap::patch(const SurfacePatch& patch) {
  const MapChange change(*published_, "patch");
  const maps::CellBox window = placeOf(patch, *site_, any_height_);
  take(patch, window);
  changed_.push_back(measureAgain(window));
  if (!patch.classes.empty()) {
    changed_.push_back(curves_->takeClasses(window));
    learned_.push_back(window);
  }
  publish(std::exchange(learned_, {}));
}

void TraversabilityMap::take(const SurfacePatch& patch, const maps::CellBox& window) {
  takeHazards(patch, window);
  bool any = any_height_;
  forEachGiven(patch.elevation_m, window, [&](maps::Cell cell, float height_m) {
    if (std::isnan(height_m)) return;
    site_->elevation.elevation_m[cell] = height_m;
    any = true;
  });
  if (any && !any_height_) site_->keys = SurfaceKeys(grid(), middleElevation(patch.elevation_m));
  any_height_ = any;
  forEachGiven(patch.classes, window, [&](maps::Cell cell, std::uint8_t number) {
    if (number != GroundSite::kNoClass) site_->classes[cell] = number;
  });
}

void TraversabilityMap::takeHazards(const SurfacePatch& patch, const maps::CellBox& window) {
  if (patch.rock_abundance.empty() && patch.keep_out.empty()) return;
  if (given_.empty()) given_ = maps::Raster<Hazard>(grid(), Hazard::None);
  forEachGiven(patch.rock_abundance, window, [&](maps::Cell cell, float abundance) {
    if (!std::isnan(abundance)) given_[cell] = without(given_[cell], Hazard::Rocks) | rocksOn(abundance);
  });
  forEachGiven(patch.keep_out, window, [&](maps::Cell cell, std::uint8_t keep_out) {
    given_[cell] = with(given_[cell], Hazard::KeepOut, keep_out != 0);
  });
}

// A changed cell changes the shape of those whose footprint it lies in; these may begin or cease to be kept clear of,
// or to lie at the edge of what is. Refused places were never kept clear of: they are left out meanwhile.
maps::CellBox TraversabilityMap::measureAgain(const maps::CellBox& window) {
  const SurfaceShape shapes(footprint(threads_));
  const maps::CellBox shaped = grown(window, shapes.reach(grid()), grid());
  const maps::CellBox judged = grown(shaped, inflationReach(limits_, grid().resolution_m) + 1, grid());
  for (const RefusedPlace& refusal : refusals_) mark(refusal, false);
  forEachCell(judged, [&](maps::Cell cell) {
    hazards_[cell] = without(hazards_[cell], Hazard::Near) | layerHazards(cell);
  });
  maps::Grid part = grid();
  part.width = shaped.width();
  part.height = shaped.height();
  measured_ = {
      .box = shaped,
      .codes = maps::Raster<CellCode>(part),
      .elevation_m = retiled(published()->content().elevation_m, site_->elevation.elevation_m, window)};
  shapes.measure(
      site_->elevation.elevation_m, shaped, limits_,
      [&](maps::Cell cell, const GroundShape& shape, Hazard found) {
        hazards_[cell] = found | layerHazards(cell);
        measured_->codes[{cell.column - shaped.first.column, cell.row - shaped.first.row}] = flatCode(shape);
      },
      {});
  inflate(hazards_, limits_, spreading(), judged);
  for (const RefusedPlace& refusal : refusals_) mark(refusal, true);
  return judged;
}

CellCode TraversabilityMap::coded(maps::Cell cell, CellCode code) {
  if (measured_ && contains(measured_->box, cell))
    code = measured_->codes[{cell.column - measured_->box.first.column, cell.row - measured_->box.first.row}];
  const Hazard found = hazards_[cell];
  if (found == Hazard::None) return code.withCurve(curves_->number(cell));
  if (found != Hazard::Unknown) return code.withCurve(CellCode::kBlocked);
  if (!model().parts().policy.allow_unknown) return code.withCurve(CellCode::kUnknown);
  // Shape that cannot be measured is no reason to forget what is known of the soil.
  return code.withCurve(classIndex(cell) >= 0 ? curves_->number(cell) : curves_->numberOfUnseen(cell));
}

void TraversabilityMap::refuse(const maps::Point& place, double radius_m) {
  if (!std::isfinite(place.x_m) || !std::isfinite(place.y_m) || !std::isfinite(radius_m) || radius_m <= 0.0)
    throw std::invalid_argument("refuse: the place must be finite, the radius finite and > 0");
  const MapChange change(*published_, "refuse");
  refusals_.push_back({place, radius_m});
  changed_.push_back(mark(refusals_.back(), true));
}

// Marks the cells of a refusal, or gives them back to their layers. The box around them.
maps::CellBox TraversabilityMap::mark(const RefusedPlace& refusal, bool refused) {
  const double cell_m = grid().resolution_m;
  const auto clamped = [](double value, int cells) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(cells - 1)));
  };
  const double x = (refusal.place.x_m - grid().south_west.x_m) / cell_m,
               y = (refusal.place.y_m - grid().south_west.y_m) / cell_m;
  const double reach = refusal.radius_m / cell_m;
  const maps::CellBox range{{clamped(x - reach, grid().width), clamped(y - reach, grid().height)},
                            {clamped(x + reach, grid().width), clamped(y + reach, grid().height)}};
  forEachCell(range, [&](maps::Cell cell) {
    const maps::Point centre = grid().centre(cell);
    if (std::hypot(centre.x_m - refusal.place.x_m, centre.y_m - refusal.place.y_m) > refusal.radius_m) return;
    const bool there = refused || has(layerHazards(cell), Hazard::Obstacle);
    hazards_[cell] = with(hazards_[cell], Hazard::Obstacle, there);
  });
  return range;
}

}  // namespace talus::costmap
