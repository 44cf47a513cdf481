// Shows   elevation maps of grid_map as patches of a Talus map, and layers of a Talus map for grid_map.
// Needs   talus::planner, grid_map_core.  Used by nav2_planner.cpp; usable in any node with both libraries.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <grid_map_core/GridMap.hpp>

#include <talus/planner/planner.hpp>

namespace talus_ros2 {

/// Converter from cells of a Talus grid to indices of a grid map (grid_map::GridMap). Index (0, 0) of a grid
/// map is the cell with the largest x and y; the first index runs against x, the second against y. The data
/// is a ring buffer, in which cell (0, 0) is stored at the start index.
class CellsOf {
 public:
  explicit CellsOf(const grid_map::GridMap& map)
      : size_(map.getSize()), start_(map.getStartIndex()), resolution_m_(map.getResolution()) {
    // The position of a grid map is its centre; the corner is half its length away.
    south_west_ = {map.getPosition().x() - 0.5 * size_(0) * resolution_m_,
                   map.getPosition().y() - 0.5 * size_(1) * resolution_m_};
  }
  /// Returns the Talus grid that covers the grid map, with width along x and height along y.
  talus::maps::Grid grid() const {
    return {.width = size_(0), .height = size_(1), .resolution_m = resolution_m_, .south_west = south_west_};
  }
  /// Returns the index in the ring buffer of a cell of grid().
  grid_map::Index index(talus::maps::Cell cell) const {
    return {(size_(0) - 1 - cell.column + start_(0)) % size_(0),
            (size_(1) - 1 - cell.row + start_(1)) % size_(1)};
  }

 private:
  grid_map::Size size_;
  grid_map::Index start_;
  double resolution_m_;
  talus::maps::Point south_west_;
};

/// Returns the offset, in cells, between the cells of two grids with corners at `a_m` and `b_m` on one axis:
/// the distance of (a_m - b_m) / resolution_m from the nearest integer, [0, 0.5].
inline double offset(double a_m, double b_m, double resolution_m) {
  const double cells = (a_m - b_m) / resolution_m;
  return std::abs(cells - std::round(cells));
}

/// Returns the heights of the layer `layer` of the grid map `seen` as a patch of the Talus map with the grid
/// `map`. The patch is cropped to the map; it is NaN where the layer is NaN. Returns nullopt if layer and map
/// do not overlap or no height is known. Throws std::invalid_argument if the layer is missing, if the
/// resolutions differ, or if the cells of both grids are offset by more than 0.01 cells. Heights are not
/// interpolated, because interpolation would flatten steps.
inline std::optional<talus::costmap::SurfacePatch> patchOf(const grid_map::GridMap& seen,
                                                           const std::string& layer,
                                                           const talus::maps::Grid& map) {
  if (!seen.exists(layer)) throw std::invalid_argument("grid map: no layer '" + layer + "'");
  const CellsOf cells(seen);
  const talus::maps::Grid all = cells.grid();
  if (std::abs(all.resolution_m - map.resolution_m) > 1e-6 * map.resolution_m)
    throw std::invalid_argument("grid map: resolution " + std::to_string(all.resolution_m) +
                                " m, the map's is " + std::to_string(map.resolution_m) +
                                " m; set both to one value");
  if (offset(all.south_west.x_m, map.south_west.x_m, map.resolution_m) > 0.01 ||
      offset(all.south_west.y_m, map.south_west.y_m, map.resolution_m) > 0.01)
    throw std::invalid_argument("grid map: its cells lie between the map's; move the map by part of a cell");
  const auto first = [&](double seen_m, double map_m) {
    return static_cast<int>(std::round((seen_m - map_m) / map.resolution_m));
  };
  const int east = first(all.south_west.x_m, map.south_west.x_m);
  const int north = first(all.south_west.y_m, map.south_west.y_m);
  const talus::maps::Cell low{std::max(east, 0), std::max(north, 0)};
  talus::maps::Grid window = map;
  window.width = std::min(east + all.width, map.width) - low.column;
  window.height = std::min(north + all.height, map.height) - low.row;
  if (window.width < 1 || window.height < 1) return std::nullopt;
  window.south_west = {map.south_west.x_m + low.column * map.resolution_m,
                       map.south_west.y_m + low.row * map.resolution_m};
  talus::costmap::SurfacePatch patch;
  patch.elevation_m = talus::maps::Raster<float>(window, std::numeric_limits<float>::quiet_NaN());
  const grid_map::Matrix& data = seen.get(layer);
  bool any = false;
  for (int row = 0; row < window.height; ++row)
    for (int column = 0; column < window.width; ++column) {
      const grid_map::Index at = cells.index({low.column + column - east, low.row + row - north});
      const float height_m = data(at(0), at(1));
      patch.elevation_m[{column, row}] = height_m;
      any = any || !std::isnan(height_m);
    }
  if (!any) return std::nullopt;
  return patch;
}

/// Returns the whole Talus map as a grid map with the layers `elevation` [m], `category` (0 safe, 1 marginal,
/// 2 dangerous; NaN: not observed), `drawbar_pull` (mean of DP/W, drawbar pull over load) and
/// `drawbar_pull_std` (its standard deviation). `frame` is the frame of the grid map.
inline grid_map::GridMap gridMapOf(const talus::costmap::TraversabilityMap& map, const std::string& frame) {
  const talus::maps::Grid& grid = map.grid();
  grid_map::GridMap out({"elevation", "category", "drawbar_pull", "drawbar_pull_std"});
  out.setFrameId(frame);
  const grid_map::Length length_m(grid.width * grid.resolution_m, grid.height * grid.resolution_m);
  out.setGeometry(length_m, grid.resolution_m,
                  {grid.south_west.x_m + 0.5 * length_m.x(), grid.south_west.y_m + 0.5 * length_m.y()});
  const CellsOf cells(out);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const talus::costmap::CellBelief b = map.belief({column, row});
      const grid_map::Index at = cells.index({column, row});
      const auto put = [&](const char* layer, float value) { out.get(layer)(at(0), at(1)) = value; };
      const float unknown = std::numeric_limits<float>::quiet_NaN();
      put("elevation", map.elevation().elevation_m[{column, row}]);
      put("category", b.category > 2 ? unknown : static_cast<float>(b.category));
      put("drawbar_pull", b.pull_mean);
      put("drawbar_pull_std", b.pull_std);
    }
  return out;
}

}  // namespace talus_ros2
