#pragma once

#include "raster.hpp"

namespace safety {

/// Extent over which steps are searched.
struct StepSpan {
  double radius_m =
      0.0;  ///< radius of the disc about the cell's centre; one of the two cells of a step lies in it
  double wheel_m = 0.0;  ///< largest distance between the two cells in a line; neighbours always count
};

/// The highest step under a rover [m]: the deviation of the rise between two cells of a row, column or
/// diagonal from the smaller slope common to both sides (0 if the sides slope in opposite directions). A
/// side without data is taken as equal to the other side.
double stepUnder(const Raster& elevation_m, Cell cell, const StepSpan& span);

}  // namespace safety
