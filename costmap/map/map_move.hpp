#pragma once

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/map/map_surface.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// How the window of a map that moves with the rover is shifted: whole tiles drop out at one side and come in, unseen, at the
/// other. Immutable.
class MapShift {
 public:
  /// By so many tiles of 64 cells further east (columns) and north (rows), where evidence is kept in blocks of so many cells a
  /// side. Throws std::invalid_argument where nothing of the map would be left or a tile holds no whole number of blocks.
  MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells);

  /// What is left of a surface.
  MapLayers layers(const MapSurface& surface) const;
  /// Where the evidence of a block is in the new window; it may lie outside.
  SavedBlock block(SavedBlock saved) const;

 private:
  template <typename T>
  maps::Raster<T> shifted(const maps::Raster<T>& old, T unseen) const;
  Floors floors(const MapSurface& surface) const;

  maps::Cell cells_;
  maps::Grid grid_;  // of the new window
  int block_cells_;
};

}  // namespace talus::costmap
