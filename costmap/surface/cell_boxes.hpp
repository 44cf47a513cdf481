#pragma once

#include <algorithm>

#include <talus/maps/grid/grid.hpp>

/// Functions on rectangles of cells.
namespace talus::costmap {

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

}  // namespace talus::costmap
