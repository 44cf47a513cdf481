#pragma once

#include <optional>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

/// A least-squares plane under one cell.
struct PlaneFit {
  double dz_dx = 0.0;        ///< [-]
  double dz_dy = 0.0;        ///< [-]
  double roughness_m = 0.0;  ///< root mean square residual
  double relief_m = 0.0;     ///< range of the residuals
};

/// The plane over those cells of the footprint that lie on the raster and hold data. Nothing when the middle
/// cell has none, or the others are fewer than four, fewer than a quarter of the footprint, or all in one
/// line.
std::optional<PlaneFit> fitPartialPlane(const Raster<float>& elevation_m, const Footprint& footprint,
                                        Cell cell);

}  // namespace talus::maps
