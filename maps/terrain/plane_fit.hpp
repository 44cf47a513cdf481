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

/// Geometry of the search for height steps: the pairs of cells that form a step, and the cells to which the
/// step of a pair is assigned.
struct StepReach {
  /// Returns the geometry for pairs of cells up to span_cells apart (>= 1). The step of a pair is assigned to
  /// every cell whose centre is at most radius_cells from the centre of one cell of the pair. One cell of the
  /// pair is sufficient, because the terrain step is half way between the two cells, and the rover may stand
  /// anywhere in its own cell.
  static StepReach of(double radius_cells, int span_cells);

  /// Returns the greatest column or row offset between a cell and the cells on which its step depends.
  int cells() const noexcept { return static_cast<int>(half_widths.size()) - 1 + 2 * span; }

  std::vector<int> half_widths;  ///< half widths of the rows of the disc, from the centre northwards [cells]
  int span = 1;                  ///< greatest distance between the cells of a pair [cells]
};

/// Input and output of one strip of rows. NaN marks cells without data.
struct StepRows {
  /// Elevations [m] by row. The cells up to reach.cells() beyond all four sides, and 2 kStepLanes further
  /// columns in the east, must be readable.
  const float* const* heights = nullptr;
  /// Output: greatest step near each cell, by row.
  float* const* step_m = nullptr;
  int width = 0;
  int count = 0;
};

/// Number of cells that a kernel processes at once.
inline constexpr int kStepLanes = 8;

/// Function that computes the greatest step [m] near each cell. The step of two cells of a row, column or
/// diagonal is the height rise between the two cells without the slope that both sides share (ours):
///   |d - minmod(a, b)|,  minmod(a, b) = the lesser in magnitude if the signs agree, 0 otherwise,
/// where d is the rise between the two cells, and a and b are the rises over the same distance before the
/// first cell and after the second. The step is 0 on a plane, and the full height for a vertical step on a
/// plane. At a change of slope, the step is the rise d minus the rise of the gentler side. If one side has no
/// data, the rise of the other side is used for both. If both sides have no data, minmod is 0 in rows and
/// columns, and a diagonal pair is omitted. For comparison, GESTALT and the step filter of grid maps use
/// height differences within a window (goldberg_2002, wermelinger_2016).
using StepKernel = void (*)(const StepReach& reach, const StepRows& rows);

/// Compute the steps on any processor, and on processors with AVX2. Both functions give bit-identical
/// results.
void measureStepsBaseline(const StepReach& reach, const StepRows& rows);
void measureStepsAvx2(const StepReach& reach, const StepRows& rows);

/// Returns the fastest kernel that this processor supports.
StepKernel stepKernel();

}  // namespace talus::maps
