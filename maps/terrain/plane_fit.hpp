#pragma once

#include <optional>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus::maps {

/// Footprint of a rover: the cells under the rover, as offsets from the cell of its position. The set is
/// symmetric: the sums of column, row and column * row vanish, and the sums of column^2 and row^2 are equal.
struct Footprint {
  struct Offset {
    int column = 0;
    int row = 0;
  };

  std::vector<Offset> offsets;  ///< offsets in order from south to north, then from west to east
  int reach = 0;                ///< greatest magnitude of a column or row offset [cells]
  double sum_xx = 0.0;          ///< sum of column^2 over the offsets [cells^2]
};

/// Returns the footprint of all cells whose centres lie within a radius >= sqrt(2) [cells]; a smaller radius
/// gives 3x3 cells.
Footprint discFootprint(double radius_cells);

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

/// Input and output of plane fits for one row of cells. Elevations must be readable up to footprint.reach
/// cells beyond both ends of the row, and kPlaneLanes further cells in the east; NaN: no data.
struct PlaneRow {
  /// Elevations [m] of the rows -reach to +reach around this row.
  const float* const* heights = nullptr;
  int width = 0;
  float cells_per_metre = 1.0F;
  /// Output, `width` values each: gradients eastward and northward [-], root mean square and range of the
  /// residuals.
  float* dz_dx = nullptr;
  float* dz_dy = nullptr;
  float* roughness_m = nullptr;
  float* relief_m = nullptr;
};

/// Number of cells that a kernel processes at once.
inline constexpr int kPlaneLanes = 8;

/// Fits a least-squares plane to the footprint of each cell of one row. Results are NaN if a cell of the
/// footprint is NaN.
using PlaneKernel = void (*)(const Footprint& footprint, const PlaneRow& row);

/// Fit planes on any processor, and on processors with AVX2; both functions give bit-identical results.
void fitPlanesBaseline(const Footprint& footprint, const PlaneRow& row);
void fitPlanesAvx2(const Footprint& footprint, const PlaneRow& row);

/// Returns the fastest kernel that this processor supports.
PlaneKernel planeKernel();

}  // namespace talus::maps
