#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/map/map_move.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>

namespace talus::costmap {
namespace {

// Shift of the window in cells.
maps::Cell cellsOf(const maps::Grid& grid, maps::Cell tiles) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        "TraversabilityMap: moved() by " + std::to_string(tiles.column) + ',' + std::to_string(tiles.row) +
        " tiles of 64 cells leaves nothing of the map of " + std::to_string(grid.width) + " x " +
        std::to_string(grid.height) + " cells; build a new one");
  };
  constexpr int kMost = 65536 / CostTile::kSide;
  if (tiles.column > kMost || tiles.column < -kMost || tiles.row > kMost || tiles.row < -kMost) refuse();
  const maps::Cell cells{tiles.column * CostTile::kSide, tiles.row * CostTile::kSide};
  if (std::abs(cells.column) >= grid.width || std::abs(cells.row) >= grid.height) refuse();
  return cells;
}

}  // namespace

MapShift::MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells)
    : cells_(cellsOf(grid, tiles)), grid_(grid), block_cells_(block_cells) {
  grid_.south_west.x_m += cells_.column * grid.resolution_m;
  grid_.south_west.y_m += cells_.row * grid.resolution_m;
  if (block_cells > CostTile::kSide)
    throw std::invalid_argument(
        "TraversabilityMap: moved() needs cells that keep evidence together by 64 or fewer, "
        "not " +
        std::to_string(block_cells) + "; take larger cells");
}

template <typename T>
maps::Raster<T> MapShift::shifted(const maps::Raster<T>& old, T unseen) const {
  if (old.empty()) return {};
  maps::Raster<T> out(grid_, unseen);
  forEachCell(allOf(grid_), [&](maps::Cell c) {
    const maps::Cell from{c.column + cells_.column, c.row + cells_.row};
    if (grid_.contains(from)) out[c] = old[from];
  });
  return out;
}

MapLayers MapShift::layers(const MapSurface& surface) const {
  constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  const maps::ElevationMap& elevation = surface.elevation();
  MapLayers layers;
  layers.elevation = {.elevation_m = shifted(elevation.elevation_m, kUnseen),
                      .georeference = elevation.georeference,
                      .source = elevation.source,
                      .reading = elevation.reading,
                      .files = elevation.files,
                      .notes = elevation.notes};
  layers.classes = shifted(surface.classes(), GroundSite::kNoClass);
  layers.declared = shifted(surface.declared(), Hazard::None);
  for (const CostLayer& layer : surface.costLayers())
    layers.costs.push_back({layer.name, shifted(layer.added_J_per_m, kUnseen), layer.unseen_J_per_m});
  // Octree keys are relative to the base elevation, so both maps need the same base.
  layers.base_elevation_m = surface.keys().baseElevation_m();
  return layers;
}

SavedBlock MapShift::block(SavedBlock saved) const {
  saved.block.column -= cells_.column / block_cells_;
  saved.block.row -= cells_.row / block_cells_;
  return saved;
}

}  // namespace talus::costmap
