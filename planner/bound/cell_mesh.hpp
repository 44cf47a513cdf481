#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Triangular mesh of a grid. Each cell is divided into four triangles, each of which has two neighbouring
/// corners and the centre of the cell as nodes. Nodes are numbered: first the corners, row by row from the
/// south-west, then the cell centres.
class CellMesh {
 public:
  explicit CellMesh(const maps::Grid& grid) noexcept
      : grid_(grid),
        width_(static_cast<std::size_t>(grid.width)),
        corners_((width_ + 1) * (static_cast<std::size_t>(grid.height) + 1)) {}

  /// Node indices of a cell: the corners counter-clockwise from the south-west corner, then the centre.
  using Nodes = std::array<std::uint32_t, 5>;
  /// Position of the centre in Nodes.
  static constexpr std::size_t kMiddle = 4;

  /// Returns the corner after corner k, counter-clockwise. Triangle k of a cell has corner k, corner next(k)
  /// and the centre as nodes.
  static constexpr std::size_t next(std::size_t k) noexcept { return (k + 1) % 4; }

  /// Returns the number of nodes.
  std::size_t nodes() const noexcept { return corners_ + grid_.size(); }
  /// Returns the number of nodes that are corners.
  std::size_t corners() const noexcept { return corners_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the node indices of a cell.
  Nodes nodesOf(maps::Cell cell) const noexcept {
    const auto column = static_cast<std::size_t>(cell.column), row = static_cast<std::size_t>(cell.row);
    const std::size_t south_west = row * (width_ + 1) + column;
    const auto node = [](std::size_t k) { return static_cast<std::uint32_t>(k); };
    return {node(south_west), node(south_west + 1), node(south_west + width_ + 2),
            node(south_west + width_ + 1), node(corners_ + row * width_ + column)};
  }

  /// Returns column and row of a node: in the grid of corners for a corner, in the grid of cells for a
  /// centre.
  maps::Cell positionOf(std::uint32_t node) const noexcept {
    const std::size_t columns = node < corners_ ? width_ + 1 : width_;
    const std::size_t index = node < corners_ ? node : node - corners_;
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }

  /// Returns the position of a node in map coordinates [m].
  maps::Point placeOf(std::uint32_t node) const noexcept {
    const maps::Cell at = positionOf(node);
    const double off = node < corners_ ? 0.0 : 0.5;
    return {grid_.south_west.x_m + (at.column + off) * grid_.resolution_m,
            grid_.south_west.y_m + (at.row + off) * grid_.resolution_m};
  }

 private:
  maps::Grid grid_;
  std::size_t width_, corners_;
};

}  // namespace talus::planner
