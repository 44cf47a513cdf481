#pragma once

#include <algorithm>
#include <cstddef>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/field/grid_heading.hpp>

namespace talus::planner {

/// Indexing of cells in an array with a border of one cell on every side, so that every cell of the grid has
/// eight neighbours. The index is here called the padded index.
struct PaddedGrid {
  int width = 0;   ///< number of columns without the border
  int height = 0;  ///< number of rows without the border

  std::size_t stride() const noexcept { return static_cast<std::size_t>(width) + 2; }
  std::size_t size() const noexcept { return stride() * (static_cast<std::size_t>(height) + 2); }
  /// Returns the padded index of a cell.
  std::size_t index(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row + 1) * stride() + static_cast<std::size_t>(c.column + 1);
  }
  /// Returns the cell with a padded index.
  maps::Cell cell(std::size_t index) const noexcept {
    return {static_cast<int>(index % stride()) - 1, static_cast<int>(index / stride()) - 1};
  }
  /// Returns the padded index of the neighbour in `heading` minus the padded index of a cell.
  std::ptrdiff_t offset(int heading) const noexcept {
    const maps::Cell step = kStep[static_cast<std::size_t>(heading)];
    return static_cast<std::ptrdiff_t>(step.row) * static_cast<std::ptrdiff_t>(stride()) + step.column;
  }
};

using maps::CellBox;

/// Returns the box extended by `cells` cells on every side and clipped to the grid.
inline CellBox grown(CellBox box, int cells, const PaddedGrid& grid) noexcept {
  return {
      {std::max(box.first.column - cells, 0), std::max(box.first.row - cells, 0)},
      {std::min(box.last.column + cells, grid.width - 1), std::min(box.last.row + cells, grid.height - 1)}};
}

}  // namespace talus::planner
