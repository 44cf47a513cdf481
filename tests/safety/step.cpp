#include "step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace safety {
namespace {

double heightAt(const Raster& z, Cell cell) {
  return z.holds(cell) ? z.at(cell) : std::numeric_limits<double>::quiet_NaN();
}

// The smaller of two slopes of equal sign; 0 for slopes of opposite sign.
double through(double side, double other) {
  if (side > 0.0 && other > 0.0) return std::min(side, other);
  if (side < 0.0 && other < 0.0) return std::max(side, other);
  return 0.0;
}

// The rise from a cell to the neighbour at an offset, less the slope common to the cells behind and beyond.
double stepFrom(const Raster& z, Cell from, Cell by) {
  const auto height = [&](int times) {
    return heightAt(z, {from.column + times * by.column, from.row + times * by.row});
  };
  const double rise = height(1) - height(0);
  if (std::isnan(rise)) return 0.0;
  const double behind = height(0) - height(-1), beyond = height(2) - height(1);
  if (!std::isnan(behind) && !std::isnan(beyond)) return std::abs(rise - through(behind, beyond));
  if (!std::isnan(behind)) return std::abs(rise - behind);
  if (!std::isnan(beyond)) return std::abs(rise - beyond);
  const bool diagonal = by.column != 0 && by.row != 0;
  return diagonal ? 0.0 : std::abs(rise);
}

}  // namespace

double stepUnder(const Raster& elevation_m, Cell cell, const StepSpan& span) {
  const double side = elevation_m.cell_m;
  const int reach = static_cast<int>(span.radius_m / side + 1e-9);
  const int longest = std::max(1, static_cast<int>(span.wheel_m / side + 1e-9));
  double highest = 0.0;
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      if (std::hypot(row, column) * side > span.radius_m * (1.0 + 1e-9)) continue;
      const Cell from{cell.column + column, cell.row + row};
      for (int apart = 1; apart <= longest; ++apart)
        for (int east = -1; east <= 1; ++east)
          for (int north = -1; north <= 1; ++north)
            if (east != 0 || north != 0)
              highest = std::max(highest, stepFrom(elevation_m, from, {apart * east, apart * north}));
    }
  return highest;
}

}  // namespace safety
