#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// Measures the terrain shape and the hazards of each cell of a box, in bands of rows to limit memory. The
/// results are bit-identical to those of measuring the whole map at once. Immutable.
class SurfaceShape {
 public:
  /// Throws std::invalid_argument for options that maps::terrainMetrics() rejects.
  explicit SurfaceShape(const maps::FootprintOptions& footprint) : footprint_(footprint) {}

  /// Returns the greatest column or row offset between a cell and the cells whose shape depends on the
  /// elevation of that cell.
  int reach(const maps::Grid& grid) const;

  /// Callback with a cell of the box, its terrain shape and its hazards by the limits.
  using Visit = std::function<void(maps::Cell, const GroundShape&, Hazard)>;
  /// Calls `visit` once for each cell of a box, which must lie inside the map. After a stop request through
  /// `watch`, the remaining cells are omitted.
  void measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box, const HazardLimits& limits,
               const Visit& visit, const ProgressMonitor& watch) const;

 private:
  maps::FootprintOptions footprint_;
};

}  // namespace talus::costmap
