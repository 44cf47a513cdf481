#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/costmap/surface/octree_keys.hpp>
#include <talus/costmap/surface/surface_cells.hpp>

namespace talus::costmap {
namespace {

constexpr int kMostCells = 65536;
constexpr unsigned kLevels = 17;

int firstKey(int cells) noexcept {
  return kCentreKey - cells / 2;
}

}  // namespace

SurfaceKeys::SurfaceKeys(const maps::Grid& grid, double base_elevation_m)
    : grid_(grid), base_elevation_m_(base_elevation_m) {
  if (std::max(grid.width, grid.height) > kMostCells)
    throw std::invalid_argument("SurfaceKeys: " + std::to_string(std::max(grid.width, grid.height)) +
                                " cells on a side, must be <= 65536");
}

octomap::OcTreeKey SurfaceKeys::key(maps::Cell cell, double elevation_m) const noexcept {
  const double height = std::floor((elevation_m - base_elevation_m_) / grid_.resolution_m) + kCentreKey;
  return {static_cast<octomap::key_type>(firstKey(grid_.width) + cell.column),
          static_cast<octomap::key_type>(firstKey(grid_.height) + cell.row),
          static_cast<octomap::key_type>(std::clamp(height, 0.0, kMostCells - 1.0))};
}

maps::Point SurfaceKeys::origin() const noexcept {
  return {grid_.south_west.x_m + (kCentreKey - firstKey(grid_.width)) * grid_.resolution_m,
          grid_.south_west.y_m + (kCentreKey - firstKey(grid_.height)) * grid_.resolution_m};
}

SurfacePyramid::SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys) {
  const maps::Grid& grid = elevation_m.grid();
  const octomap::OcTreeKey first = keys.key({0, 0}, keys.baseElevation_m());
  Level base{first[0], first[1], static_cast<unsigned>(grid.width), static_cast<unsigned>(grid.height), {}};
  base.ranges.resize(grid.size());
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const float elevation = elevation_m[{column, row}];
      if (std::isnan(elevation)) continue;
      const auto height = keys.key({column, row}, static_cast<double>(elevation))[2];
      base.ranges[grid.index({column, row})] = {height, height};
    }
  levels_.push_back(std::move(base));
  for (unsigned level = 1; level < kLevels; ++level) {
    const Level& below = levels_.back();
    const unsigned x0 = below.first_x >> 1, y0 = below.first_y >> 1;
    Level next{x0,
               y0,
               ((below.first_x + below.width - 1) >> 1) - x0 + 1,
               ((below.first_y + below.height - 1) >> 1) - y0 + 1,
               {}};
    next.ranges.resize(static_cast<std::size_t>(next.width) * next.height);
    for (unsigned y = 0; y < below.height; ++y)
      for (unsigned x = 0; x < below.width; ++x) {
        const Range from = below.ranges[static_cast<std::size_t>(y) * below.width + x];
        Range& to = next.ranges[static_cast<std::size_t>(((below.first_y + y) >> 1) - y0) * next.width +
                                (((below.first_x + x) >> 1) - x0)];
        to = {std::min(to.low, from.low), std::max(to.high, from.high)};
      }
    levels_.push_back(std::move(next));
  }
}

SurfacePyramid::Range SurfacePyramid::range(unsigned level, unsigned x_key, unsigned y_key) const noexcept {
  const Level& at = levels_[level];
  const unsigned x = (x_key >> level) - at.first_x, y = (y_key >> level) - at.first_y;
  if (x >= at.width || y >= at.height) return {};
  return at.ranges[static_cast<std::size_t>(y) * at.width + x];
}

}  // namespace talus::costmap
