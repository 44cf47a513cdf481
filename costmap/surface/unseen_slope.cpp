#include <cmath>
#include <optional>

#include <talus/costmap/surface/unseen_slope.hpp>

namespace talus::costmap {
namespace {

struct Sight {
  double height_m;
  int cells;  // distance of the height [cells]
};

std::optional<Sight> nearest(const maps::Raster<float>& elevation_m, maps::Cell cell, maps::Cell step) {
  for (int cells = 1; cells <= kUnseenReach; ++cells) {
    const maps::Cell there{cell.column + cells * step.column, cell.row + cells * step.row};
    if (!elevation_m.grid().contains(there)) return std::nullopt;
    if (const float z = elevation_m[there]; !std::isnan(z)) return Sight{static_cast<double>(z), cells};
  }
  return std::nullopt;
}

double between(const maps::Raster<float>& elevation_m, maps::Cell cell, maps::Cell step) {
  const auto ahead = nearest(elevation_m, cell, step),
             behind = nearest(elevation_m, cell, {-step.column, -step.row});
  if (!ahead || !behind) return 0.0;
  return (ahead->height_m - behind->height_m) /
         ((ahead->cells + behind->cells) * elevation_m.grid().resolution_m);
}

}  // namespace

UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell) {
  return {between(elevation_m, cell, {1, 0}), between(elevation_m, cell, {0, 1})};
}

}  // namespace talus::costmap
