#pragma once

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/map/map_surface.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Shift of the window that a map covers, by whole tiles (blocks of 64x64 cells): tiles are dropped at one
/// side, and unobserved tiles are added at the other side. Immutable.
class MapShift {
 public:
  /// Makes the shift of `grid` by `tiles` tiles eastward (columns) and northward (rows). Blocks of evidence
  /// have block_cells cells per side. Throws std::invalid_argument if the new window does not overlap the old
  /// window, or if a block is larger than a tile.
  MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells);

  /// Returns the layers of a surface on the new window; unobserved cells are NaN, or have no class and no
  /// hazard.
  MapLayers layers(const MapSurface& surface) const;
  /// Returns the evidence block `saved` with its position in the new window; the position may be outside the
  /// window.
  SavedBlock block(SavedBlock saved) const;

 private:
  template <typename T>
  maps::Raster<T> shifted(const maps::Raster<T>& old, T unseen) const;

  maps::Cell cells_;
  maps::Grid grid_;  // grid of the new window
  int block_cells_;
};

}  // namespace talus::costmap
