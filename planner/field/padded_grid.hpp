#pragma once

#include <algorithm>
#include <cstddef>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/field/grid_heading.hpp>

namespace talus::planner {

/// Index of a cell in arrays with a border of one cell on every side, so that every cell has eight
/// neighbours.
struct PaddedGrid {
  int width = 0;  ///< columns without the border
  int height = 0;

  std::size_t stride() const noexcept { return static_cast<std::size_t>(width) + 2; }
  std::size_t size() const noexcept { return stride() * (static_cast<std::size_t>(height) + 2); }
  std::size_t index(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row + 1) * stride() + static_cast<std::size_t>(c.column + 1);
  }
  maps::Cell cell(std::size_t index) const noexcept {
    return {static_cast<int>(index % stride()) - 1, static_cast<int>(index / stride()) - 1};
  }
  /// Returns the difference between the padded indices of the neighbour in a heading and of the cell.
  std::ptrdiff_t offset(int heading) const noexcept {
    const maps::Cell step = kStep[static_cast<std::size_t>(heading)];
    return static_cast<std::ptrdiff_t>(step.row) * static_cast<std::ptrdiff_t>(stride()) + step.column;
  }
};

using maps::CellBox;

/// The box extended by `cells` cells on every side, clipped to the grid.
inline CellBox grown(CellBox box, int cells, const PaddedGrid& grid) noexcept {
  return {
      {std::max(box.first.column - cells, 0), std::max(box.first.row - cells, 0)},
      {std::min(box.last.column + cells, grid.width - 1), std::min(box.last.row + cells, grid.height - 1)}};
}

}  // namespace talus::planner
