#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Slope of the ground: rise over run eastward (dz_dx) and northward (dz_dy) [-].
struct UnseenSlope {
  double dz_dx = 0.0, dz_dy = 0.0;
};

/// Greatest distance from a cell to the elevations from which unseenSlope() computes its slope [cells].
inline constexpr int kUnseenReach = 32;

/// Returns the slope of a cell without a measured shape. Along the row and along the column of the cell, the
/// slope is the height difference of the nearest cells with an elevation on both sides, divided by their
/// distance; the ground has at least this slope somewhere in between. The slope along an axis is 0 if one
/// side has no elevation within kUnseenReach cells. NaN elevations are skipped.
UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell);

}  // namespace talus::costmap
