#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// Terrain shape and hazards at each cell of a box, measured in bands of rows to limit memory. The results
/// are bit-identical to those of measuring the whole map at once. Immutable.
class SurfaceShape {
 public:
  /// Throws std::invalid_argument as maps::terrainMetrics().
  explicit SurfaceShape(const maps::FootprintOptions& footprint) : footprint_(footprint) {}

  /// Returns the greatest column or row offset between a cell and the cells whose shape depends on its
  /// height.
  int reach(const maps::Grid& grid) const;

  /// Receives a cell of the box, its shape and its hazards by the limits.
  using Visit = std::function<void(maps::Cell, const GroundShape&, Hazard)>;
  /// Visits each cell of a box inside the map once; after a stop request, remaining cells are omitted.
  void measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box, const HazardLimits& limits,
               const Visit& visit, const ProgressMonitor& watch) const;

 private:
  maps::FootprintOptions footprint_;
};

}  // namespace talus::costmap
