#pragma once

#include <optional>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

/// A least-squares plane fitted to the elevations of the footprint of a cell, i.e. the cells under a rover.
struct PlaneFit {
  double dz_dx = 0.0;        ///< gradient of the plane eastward [-]
  double dz_dy = 0.0;        ///< gradient of the plane northward [-]
  double roughness_m = 0.0;  ///< root mean square of the residuals
  double relief_m = 0.0;     ///< greatest residual minus least residual
};

/// Returns the plane fitted to the cells of the footprint that lie on the raster and have data. Returns
/// nullopt if `cell` has no data, or if the cells with data (`cell` included) are fewer than four, fewer than
/// a quarter of the footprint, or collinear.
std::optional<PlaneFit> fitPartialPlane(const Raster<float>& elevation_m, const Footprint& footprint,
                                        Cell cell);

}  // namespace talus::maps
