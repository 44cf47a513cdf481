#pragma once

#include <vector>

namespace talus::maps {

/// Pairs of cells that form a step, and the cells to which the pairs are assigned.
struct StepReach {
  /// Pairs of cells up to span_cells apart (>= 1). A pair is assigned to every cell whose centre is at
  /// most radius_cells from the centre of one cell of the pair. One is sufficient, because the terrain step
  /// is half way between the two cells, and the rover may stand anywhere in its own cell.
  static StepReach of(double radius_cells, int span_cells);

  /// Returns the greatest column or row offset of the cells that the step of a cell depends on.
  int cells() const noexcept { return static_cast<int>(half_widths.size()) - 1 + 2 * span; }

  std::vector<int> half_widths;  ///< half widths of the disc's rows, from the centre northwards [cells]
  int span = 1;                  ///< greatest distance of a pair [cells]
};

/// Heights of a strip of rows (NaN for no data) and the output rows.
struct StepRows {
  const float* const* heights = nullptr;  ///< readable reach.cells() beyond all four sides and 2 kStepLanes
                                          ///< more columns in the east
  float* const* step_m = nullptr;
  int width = 0;
  int count = 0;
};

inline constexpr int kStepLanes = 8;

/// Computes the greatest step [m] near each cell. The step of two cells of a row, column or diagonal is the
/// rise between the cells without the slope that both sides share (ours):
///   |d - minmod(a, b)|,  minmod(a, b) = the lesser in magnitude if the signs agree, else 0,
/// where d is the rise between the two cells, and a and b are the rises over the same distance before and
/// after. The step is 0 on a plane and the full height for a vertical step on a plane; at a change of slope,
/// the step is the rise d minus the rise of the gentler side. If one side has no data, the other side
/// replaces it. If both sides have no data, minmod is 0 in rows and columns, and a diagonal pair is omitted.
/// GESTALT and the step filter of grid maps use height differences within a window (goldberg_2002,
/// wermelinger_2016).
using StepKernel = void (*)(const StepReach& reach, const StepRows& rows);

/// Kernels for any processor and for processors with AVX2; both give the same bits.
void measureStepsBaseline(const StepReach& reach, const StepRows& rows);
void measureStepsAvx2(const StepReach& reach, const StepRows& rows);

/// The fastest kernel that this processor supports.
StepKernel stepKernel();

}  // namespace talus::maps
