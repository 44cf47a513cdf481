#pragma once

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/map/map_surface.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Shift of a map window by whole tiles: tiles are dropped at one side, and unseen tiles are added at the
/// other. Immutable.
class MapShift {
 public:
  /// Shift by `tiles` tiles of 64 cells eastward (columns) and northward (rows); evidence blocks have
  /// block_cells cells per side. Throws std::invalid_argument if the new window does not overlap the old one,
  /// or if a block is larger than a tile.
  MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells);

  /// The shifted layers of a surface; unseen cells are NaN or without class and hazard.
  MapLayers layers(const MapSurface& surface) const;
  /// Returns the evidence block with its position in the new window, or outside the window.
  SavedBlock block(SavedBlock saved) const;

 private:
  template <typename T>
  maps::Raster<T> shifted(const maps::Raster<T>& old, T unseen) const;
  Floors floors(const MapSurface& surface) const;

  maps::Cell cells_;
  maps::Grid grid_;  // grid of the new window
  int block_cells_;
};

}  // namespace talus::costmap
