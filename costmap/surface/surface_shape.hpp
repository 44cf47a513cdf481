#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// The shape of the ground under the footprint at each cell, measured in boxes of a map: the same bits as measuring
/// all of it, in a sixteenth of the memory. Immutable.
class SurfaceShape {
 public:
  /// Throws std::invalid_argument as maps::terrainMetrics() does.
  explicit SurfaceShape(const maps::FootprintOptions& footprint) : footprint_(footprint) {}

  /// How many columns and rows, at most, lie between a cell and those whose shape its height takes part in.
  int reach(const maps::Grid& grid) const;

  /// A cell of the box, its shape and what limits make of that.
  using Visit = std::function<void(maps::Cell, const GroundShape&, Hazard)>;
  /// Visits each cell of a box inside the map once. Once a stop is requested the rest is left out.
  void measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box, const HazardLimits& limits,
               const Visit& visit, const ProgressMonitor& watch) const;

 private:
  maps::FootprintOptions footprint_;
};

}  // namespace talus::costmap
