#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Options of terrainMetrics().
struct FootprintOptions {
  double radius_m =
      0.0;  ///< radius of the disc under the rover; a disc smaller than 3x3 cells is replaced by 3x3 cells
  double step_span_m = 0.0;  ///< greatest distance of heights that form a step, >= 0; at least one cell
  int threads = 1;           ///< >= 1; the result does not depend on the number of threads
};

/// Terrain shape under a rover at each cell: the least-squares plane over the disc of the footprint, and the
/// residuals. NaN if the cell has no data, or if fewer than a quarter of the footprint has data.
struct TerrainMetrics {
  Raster<float> dz_dx;        ///< gradient of the plane eastward [-]
  Raster<float> dz_dy;        ///< gradient of the plane northward [-]
  Raster<float> roughness_m;  ///< root mean square of the residuals
  Raster<float> relief_m;     ///< greatest minus least residual
  Raster<float>
      step_m;  ///< greatest step under the rover, reduced by the slope on both sides (step_height.hpp);
               ///< relief_m is only 0.5 to 0.8 of a vertical step, because the fitted plane tilts
  int footprint_cells = 0;                  ///< number of cells of a complete footprint
  bool fell_back = false;                   ///< true if 3x3 cells replace a smaller footprint
  double gradient_std_per_roughness = 0.0;  ///< standard error of a gradient for roughness 1 m [1/m]

  /// Inclination of the plane [rad], 0 to pi/2.
  float slope_rad(Cell c) const;

  /// Downslope direction of the plane, counter-clockwise from east [rad], -pi to pi.
  float aspect_rad(Cell c) const;
};

/// Returns an upper bound of the column or row offset of the cells that the metrics of a cell depend on.
int metricsReach(const FootprintOptions& options, double resolution_m);

/// Computes the metrics of all cells of a raster (NaN for no data); the cost per cell is proportional to the
/// cells of the footprint. After a stop request, remaining rows stay NaN. @throws std::invalid_argument for a
/// radius or span that is negative or not finite, or for threads < 1
TerrainMetrics terrainMetrics(const Raster<float>& elevation_m, const FootprintOptions& options,
                              const ProgressMonitor& watch = {});

}  // namespace talus::maps
