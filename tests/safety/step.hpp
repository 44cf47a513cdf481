#pragma once

#include "raster.hpp"

namespace safety {

/// What a step is looked for over.
struct StepSpan {
  double radius_m = 0.0;  ///< of the disc about the cell's centre that one of the two cells lies in
  double wheel_m = 0.0;   ///< cells in a line up to this far apart, neighbours always
};

/// The highest step under a rover [m]: by what the ground between two cells of a row, column or diagonal rises more or
/// less than the gentlest slope that would go on through from one side to the other (none where the sides fall
/// different ways). A side that the map does not know is as the other.
double stepUnder(const Raster& elevation_m, Cell cell, const StepSpan& span);

}  // namespace safety
