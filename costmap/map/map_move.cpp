#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/published_map.hpp>
#include <talus/costmap/evidence/block_grid.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>

// A map that goes with the rover: whole tiles fall off at one side and come in, unseen, at the other.
namespace talus::costmap {
namespace {

// How many cells further east and north the new window lies.
struct Shift {
  maps::Cell cells;
  maps::Grid grid;  // of the new window

  template <typename T>
  maps::Raster<T> of(const maps::Raster<T>& old, T unseen) const {
    if (old.empty()) return {};
    maps::Raster<T> out(grid, unseen);
    forEachCell(allOf(grid), [&](maps::Cell c) {
      const maps::Cell from{c.column + cells.column, c.row + cells.row};
      if (grid.contains(from)) out[c] = old[from];
    });
    return out;
  }
};

Shift shiftOf(const maps::Grid& grid, maps::Cell tiles) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        "TraversabilityMap: moved() by " + std::to_string(tiles.column) + ',' + std::to_string(tiles.row) +
        " tiles of 64 cells leaves nothing of the map of " + std::to_string(grid.width) + " x " +
        std::to_string(grid.height) + " cells; build a new one");
  };
  constexpr int kMost = 65536 / CostTile::kSide;
  if (tiles.column > kMost || tiles.column < -kMost || tiles.row > kMost || tiles.row < -kMost) refuse();
  Shift shift{.cells = {tiles.column * CostTile::kSide, tiles.row * CostTile::kSide}, .grid = grid};
  if (std::abs(shift.cells.column) >= grid.width || std::abs(shift.cells.row) >= grid.height) refuse();
  shift.grid.south_west.x_m += shift.cells.column * grid.resolution_m;
  shift.grid.south_west.y_m += shift.cells.row * grid.resolution_m;
  return shift;
}

Floors floorsOf(const GroundSite& site, const Shift& shift) {
  std::vector<Floor> left;
  for (Floor floor : site.floors.all()) {
    const auto width = static_cast<std::uint32_t>(site.grid().width);
    const maps::Cell to{static_cast<int>(floor.cell % width) - shift.cells.column,
                        static_cast<int>(floor.cell / width) - shift.cells.row};
    if (!shift.grid.contains(to)) continue;
    floor.cell = static_cast<std::uint32_t>(shift.grid.index(to));
    left.push_back(floor);
  }
  return Floors(std::move(left), shift.grid.size());
}

}  // namespace

TraversabilityMap TraversabilityMap::moved(maps::Cell tiles, const ProgressMonitor& watch) const {
  constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  const Shift shift = shiftOf(grid(), tiles);
  const int side = BlockGrid(site_).side();
  if (side > CostTile::kSide)
    throw std::invalid_argument(
        "TraversabilityMap: moved() needs cells that keep evidence together by 64 or fewer, "
        "not " +
        std::to_string(side) + "; take larger cells");
  MapLayers layers;
  layers.elevation = {.elevation_m = shift.of(site_->elevation.elevation_m, kUnseen),
                      .georeference = site_->elevation.georeference,
                      .source = site_->elevation.source,
                      .notes = site_->elevation.notes};
  layers.classes = shift.of(site_->classes, GroundSite::kNoClass);
  layers.declared = shift.of(given_, Hazard::None);
  layers.floors = floorsOf(*site_, shift);
  for (const CostLayer& layer : site_->costs)
    layers.costs.push_back({layer.name, shift.of(layer.added_J_per_m, kUnseen), layer.unseen_J_per_m});
  TraversabilityMap next(std::move(layers), site_->model,
                         {.footprint_radius_m = footprint_radius_m_, .threads = threads_}, watch);
  // Levels beneath the top are heights above the base: both maps have the same.
  next.site_->keys = SurfaceKeys(next.grid(), keys().baseElevation_m());
  field_.visit([&](SavedBlock saved) {
    saved.block.column -= shift.cells.column / side;
    saved.block.row -= shift.cells.row / side;
    next.field_.restore(saved);
  });
  next.drives_ = drives_;
  for (const RefusedPlace& refusal : refusals_) next.refuse(refusal.place, refusal.radius_m);
  next.publishAll();
  CostGrid::Content content = next.published()->content();
  content.version = published()->version() + 1;
  next.published_->grid.store(std::make_shared<CostGrid>(std::move(content)));
  return next;
}

}  // namespace talus::costmap
