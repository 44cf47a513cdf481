#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Options of terrainMetrics(). The footprint of a cell is the set of cells under a rover at that cell.
struct FootprintOptions {
  /// Radius of the disc-shaped footprint; a disc smaller than 3x3 cells is replaced by 3x3 cells.
  double radius_m = 0.0;
  /// Greatest horizontal distance of two heights that form a step, >= 0; at least one cell is used.
  double step_span_m = 0.0;
  int threads = 1;  ///< number of threads, >= 1; the result does not depend on this number
};

/// Terrain shape under a rover at each cell: the gradients of the least-squares plane over the footprint, and
/// the residuals, i.e. the height differences between the cells and the plane. The values of a cell are NaN
/// if the cell has no data, or if fewer than a quarter of its footprint has data.
struct TerrainMetrics {
  Raster<float> dz_dx;        ///< gradient of the plane eastward [-]
  Raster<float> dz_dy;        ///< gradient of the plane northward [-]
  Raster<float> roughness_m;  ///< root mean square of the residuals
  Raster<float> relief_m;     ///< greatest residual minus least residual
  /// Greatest height step under the rover. The slope on both sides of the step is subtracted
  /// (step_height.hpp). relief_m is only 0.5 to 0.8 of a vertical step, because the fitted plane tilts.
  Raster<float> step_m;
  int footprint_cells = 0;  ///< number of cells of a complete footprint
  bool fell_back = false;   ///< true if 3x3 cells replace a smaller footprint
  /// Standard error of dz_dx and dz_dy for a roughness of 1 m [1/m].
  double gradient_std_per_roughness = 0.0;

  /// Returns the inclination of the plane at a cell [rad], 0 to pi/2.
  float slope_rad(Cell c) const;

  /// Returns the downslope direction of the plane at a cell [rad], counter-clockwise from east, -pi to pi.
  float aspect_rad(Cell c) const;
};

/// Returns the greatest column or row offset [cells] between a cell and the cells on which its metrics
/// depend; the value may be an upper bound.
int metricsReach(const FootprintOptions& options, double resolution_m);

/// Returns the terrain shape at all cells of an elevation raster (NaN for no data). The computing time per
/// cell is proportional to the number of cells of the footprint. After a stop request through `watch`, the
/// remaining rows stay NaN. @throws std::invalid_argument for a radius or span that is negative or not
/// finite, or for threads < 1
TerrainMetrics terrainMetrics(const Raster<float>& elevation_m, const FootprintOptions& options,
                              const ProgressMonitor& watch = {});

}  // namespace talus::maps
