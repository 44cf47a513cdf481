#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// How terrain is measured.
struct FootprintOptions {
  double radius_m =
      0.0;  ///< disc under the rover; one that reaches no diagonal neighbour falls back to 3x3 cells
  double step_span_m = 0.0;  ///< heights up to this far apart make a step; neighbouring cells always do, >= 0
  int threads = 1;           ///< >= 1; the result does not depend on it
};

/// Shape of the ground under a rover that stands at each cell: the least-squares plane over the disc of its
/// footprint and what departs from it. NaN where the cell has no data or fewer than a quarter of its
/// footprint has.
struct TerrainMetrics {
  Raster<float> dz_dx;        ///< plane's gradient eastward [-]
  Raster<float> dz_dy;        ///< plane's gradient northward [-]
  Raster<float> roughness_m;  ///< root mean square residual of the plane
  Raster<float> relief_m;  ///< highest minus lowest residual: what the plane does not explain of the relief
  Raster<float>
      step_m;  ///< highest step under the rover beyond the slope on both sides of it (step_height.hpp): the
               ///< plane tilts with a sheer step and leaves 0.5 to 0.8 of it, this has all of it
  int footprint_cells = 0;                  ///< cells of a whole footprint
  bool fell_back = false;                   ///< whether 3x3 cells were taken because the footprint is smaller
  double gradient_std_per_roughness = 0.0;  ///< [1/m] standard error of a gradient for roughness 1 m

  /// Inclination of the plane [rad], 0 to pi/2.
  float slope_rad(Cell c) const;

  /// Direction the plane falls to, counter-clockwise from east [rad], -pi to pi.
  float aspect_rad(Cell c) const;
};

/// Columns and rows, at most, from a cell to those that its shape depends on.
int metricsReach(const FootprintOptions& options, double resolution_m);

/// Measures the whole raster (NaN = no data). Cost per cell grows with the cells of the footprint;
/// vectorised. Once a stop is requested the rows not yet done stay NaN.
/// @throws std::invalid_argument on a radius or span that is negative or not finite, or threads < 1
TerrainMetrics terrainMetrics(const Raster<float>& elevation_m, const FootprintOptions& options,
                              const ProgressMonitor& watch = {});

}  // namespace talus::maps
