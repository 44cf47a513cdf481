#pragma once

#include <vector>

namespace talus::maps {

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
