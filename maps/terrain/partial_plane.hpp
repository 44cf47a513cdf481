#pragma once

#include <optional>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

/// A least-squares plane fitted to the footprint of a cell.
struct PlaneFit {
  double dz_dx = 0.0;        ///< [-]
  double dz_dy = 0.0;        ///< [-]
  double roughness_m = 0.0;  ///< root mean square of the residuals
  double relief_m = 0.0;     ///< greatest minus least residual
};

/// Plane fitted to the cells of the footprint that lie on the raster and have data. Returns nullopt if the
/// central cell has no data, or if the cells with data (the central cell included) are fewer than four, fewer
/// than a quarter of the footprint, or collinear.
std::optional<PlaneFit> fitPartialPlane(const Raster<float>& elevation_m, const Footprint& footprint,
                                        Cell cell);

}  // namespace talus::maps
