#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Slope as rise over run eastward and northward [-].
struct UnseenSlope {
  double dz_dx = 0.0, dz_dy = 0.0;
};

/// Greatest distance from a cell to the heights that determine its slope [cells].
inline constexpr int kUnseenReach = 32;

/// Returns the slope of a cell without a known shape: along the row and along the column, the mean slope
/// between the nearest heights on both sides. The ground has at least this slope somewhere in between. Along
/// an axis with a side without heights within kUnseenReach the slope is 0. NaN heights are skipped.
UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell);

}  // namespace talus::costmap
