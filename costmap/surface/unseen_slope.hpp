#pragma once

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// A slope as rise over run eastwards and northwards [-].
struct UnseenSlope {
  double dz_dx = 0.0, dz_dy = 0.0;
};

/// Cells, at most, from one without a known shape to heights that bound its slope.
inline constexpr int kUnseenReach = 32;

/// What the nearest heights to both sides of a cell, along its row and along its column, say of the ground between them: the mean slope there,
/// which it has or exceeds somewhere. 0 along an axis on which a side has none within kUnseenReach. NaN is no height.
UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell);

}  // namespace talus::costmap
