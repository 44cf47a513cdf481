#pragma once

#include <vector>

namespace talus::maps {

/// Which pairs of cells make a step, and for which cells they count.
struct StepReach {
  /// Of pairs up to span_cells apart (>= 1), each for the cells whose middle lies within the radius [cells] of
  /// either of its ends: edges lie half way between cells, and a rover may stand anywhere in its cell.
  static StepReach of(double radius_cells, int span_cells);

  /// Columns and rows from a cell to those that its step may depend on, at most.
  int cells() const noexcept { return static_cast<int>(half_widths.size()) - 1 + 2 * span; }

  std::vector<int> half_widths;  ///< of the disc's rows, from its middle northwards [cells]
  int span = 1;                  ///< [cells]
};

/// Heights of a strip of rows, NaN where there is no data, and where its steps go.
struct StepRows {
  const float* const* heights = nullptr;  ///< readable reach.cells() beyond all four sides, and
                                          ///< 2 kStepLanes columns beyond that in the east
  float* const* step_m = nullptr;
  int width = 0;
  int count = 0;
};

inline constexpr int kStepLanes = 8;

/// The highest step [m] near each cell: how far two cells of a row, column or diagonal differ beyond the slope that
/// the ground on both sides of them shares,
///   |d - minmod(a, b)|,  minmod(a, b) = the lesser of both where their signs agree, else 0,
/// with d the rise between the two, a and b the rises over the same distance before and after. On a plane it is 0; a
/// sheer step on a plane has its whole height; a bend counts for what its gentler side falls short of over that distance.
/// Where one side has no data the other counts; where both have none, nothing is shared in rows and columns, and
/// a diagonal is left out. GESTALT and the step filter of grid maps take differences of heights within a window
/// (goldberg_2002, wermelinger_2016); that the shared slope is left out is ours.
using StepKernel = void (*)(const StepReach& reach, const StepRows& rows);

/// For any processor, and for one with AVX2: the same bits.
void measureStepsBaseline(const StepReach& reach, const StepRows& rows);
void measureStepsAvx2(const StepReach& reach, const StepRows& rows);

/// The fastest that this processor runs.
StepKernel stepKernel();

}  // namespace talus::maps
