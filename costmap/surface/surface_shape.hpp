#pragma once

#include <algorithm>
#include <functional>

#include <talus/common/common.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// Functions on rectangles of cells.

/// Returns the box extended by `cells` columns and rows on each side, limited to the grid.
inline maps::CellBox grown(const maps::CellBox& box, int cells, const maps::Grid& grid) noexcept {
  return {
      {std::max(box.first.column - cells, 0), std::max(box.first.row - cells, 0)},
      {std::min(box.last.column + cells, grid.width - 1), std::min(box.last.row + cells, grid.height - 1)}};
}

/// Returns the bounding box of two boxes.
inline maps::CellBox around(const maps::CellBox& a, const maps::CellBox& b) noexcept {
  return {{std::min(a.first.column, b.first.column), std::min(a.first.row, b.first.row)},
          {std::max(a.last.column, b.last.column), std::max(a.last.row, b.last.row)}};
}

/// Returns true if the cell lies inside the box.
inline bool contains(const maps::CellBox& box, maps::Cell c) noexcept {
  return c.column >= box.first.column && c.row >= box.first.row && c.column <= box.last.column &&
         c.row <= box.last.row;
}

/// Returns the box of all cells of a grid.
inline maps::CellBox allOf(const maps::Grid& grid) noexcept {
  return {{0, 0}, {grid.width - 1, grid.height - 1}};
}

/// Calls each(cell) for each cell of a box, row by row from the south-west.
template <typename Each>
void forEachCell(const maps::CellBox& box, const Each& each) {
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column) each(maps::Cell{column, row});
}

/// Returns a raster with the values of `from` in a box, on the grid of the box. The box must lie inside the
/// raster.
template <typename T>
maps::Raster<T> cut(const maps::Raster<T>& from, const maps::CellBox& box) {
  maps::Grid grid = from.grid();
  grid.width = box.width();
  grid.height = box.height();
  grid.south_west = {grid.south_west.x_m + box.first.column * grid.resolution_m,
                     grid.south_west.y_m + box.first.row * grid.resolution_m};
  maps::Raster<T> part(grid);
  for (int row = 0; row < grid.height; ++row)
    std::copy_n(from.row(box.first.row + row) + box.first.column, grid.width, part.row(row));
  return part;
}

/// Rock size that a rover cannot cross, and the area that must be free of such rocks.
struct RockCrossing {
  double diameter_m = 0.0;  ///< diameter of the smallest rock that the rover cannot cross, > 0
  double area_m2 = 0.0;     ///< area of the rover's footprint, > 0
};

/// Returns the probability P that at least one rock of diameter >= D = crossing.diameter_m lies on the area A
/// = crossing.area_m2, where rocks cover the fraction `abundance` = k (0 to 1) of the ground. Returns 0 for
/// an abundance that is NaN or not positive.
///   F(D) = k e^(-q D),  q = 1.79 + 0.152/k                 area fraction of rocks larger than D
///                                                          (golombek_rapp_1997)
///   N(D) = integral over D' > D of (-dF/dD') 4/(pi D'^2)   rocks per square metre
///        = 4 k q/pi [e^(-q D)/D - q E1(q D)]
///   P = 1 - e^(-N A)                                       Poisson distribution
/// Returns 1 for an abundance above 0.5: the distribution, which was fitted to counted fields, then
/// underestimates the number of large rocks (ours). The relative accuracy of N is 1e-6.
double rockHazard(double abundance, const RockCrossing& crossing);

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

/// Measures the terrain shape and the hazards of each cell of a box, in bands of rows to limit memory. The
/// results are bit-identical to those of measuring the whole map at once. Immutable.
class SurfaceShape {
 public:
  /// Throws std::invalid_argument for options that maps::terrainMetrics() rejects.
  explicit SurfaceShape(const maps::FootprintOptions& footprint) : footprint_(footprint) {}

  /// Returns the greatest column or row offset between a cell and the cells whose shape depends on the
  /// elevation of that cell.
  int reach(const maps::Grid& grid) const;

  /// Callback with a cell of the box, its terrain shape and its hazards by the limits.
  using Visit = std::function<void(maps::Cell, const GroundShape&, Hazard)>;
  /// Calls `visit` once for each cell of a box, which must lie inside the map. After a stop request through
  /// `watch`, the remaining cells are omitted.
  void measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box, const HazardLimits& limits,
               const Visit& visit, const ProgressMonitor& watch) const;

 private:
  maps::FootprintOptions footprint_;
};

}  // namespace talus::costmap
