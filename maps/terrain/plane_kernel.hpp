#pragma once

#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

/// One row of cells to fit and where its results go. Rows of heights are read `reach` cells beyond both ends,
/// and up to kPlaneLanes beyond the east end more; all that must be there (NaN where there is no data).
struct PlaneRow {
  const float* const* heights = nullptr;  ///< rows -reach to +reach about this one, each at its first cell
  int width = 0;
  float cells_per_metre = 1.0F;
  float* dz_dx = nullptr;
  float* dz_dy = nullptr;
  float* roughness_m = nullptr;
  float* relief_m = nullptr;
};

inline constexpr int kPlaneLanes = 8;

/// Least-squares planes over whole footprints of one row: gradients, root mean square and range of the
/// residuals. NaN wherever a cell of the footprint is NaN.
using PlaneKernel = void (*)(const Footprint& footprint, const PlaneRow& row);

/// For any processor, and for one with AVX2: the same bits.
void fitPlanesBaseline(const Footprint& footprint, const PlaneRow& row);
void fitPlanesAvx2(const Footprint& footprint, const PlaneRow& row);

/// The fastest that this processor runs.
PlaneKernel planeKernel();

}  // namespace talus::maps
