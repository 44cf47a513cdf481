#pragma once

#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

/// Input and output of a plane fit for one row of cells. Heights must be readable `reach` cells beyond both
/// ends of the row and kPlaneLanes more beyond the eastern end, NaN for no data.
struct PlaneRow {
  const float* const* heights = nullptr;  ///< rows -reach to +reach around this row, each from its first cell
  int width = 0;
  float cells_per_metre = 1.0F;
  float* dz_dx = nullptr;
  float* dz_dy = nullptr;
  float* roughness_m = nullptr;
  float* relief_m = nullptr;
};

inline constexpr int kPlaneLanes = 8;

/// Fits least-squares planes to the complete footprints of one row. Writes the gradients [-], and the root
/// mean square and range of the residuals [m]; NaN if a cell of the footprint is NaN.
using PlaneKernel = void (*)(const Footprint& footprint, const PlaneRow& row);

/// Kernels for any processor and for processors with AVX2; both give the same bits.
void fitPlanesBaseline(const Footprint& footprint, const PlaneRow& row);
void fitPlanesAvx2(const Footprint& footprint, const PlaneRow& row);

/// The fastest kernel that this processor supports.
PlaneKernel planeKernel();

}  // namespace talus::maps
