#pragma once

#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

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
