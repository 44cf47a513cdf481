#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// A grid cut into triangles: each cell into four, between two neighbouring corners and its middle. Nodes are the
/// corners, row by row from the south-west, then the middles.
class CellMesh {
 public:
  explicit CellMesh(const maps::Grid& grid) noexcept
      : grid_(grid),
        width_(static_cast<std::size_t>(grid.width)),
        corners_((width_ + 1) * (static_cast<std::size_t>(grid.height) + 1)) {}

  /// Nodes of a cell: corners counter-clockwise from the south-west one, then the middle.
  using Nodes = std::array<std::uint32_t, 5>;
  static constexpr std::size_t kMiddle = 4;

  /// Triangle k of a cell lies between its corners k and k + 1 and its middle.
  static constexpr std::size_t next(std::size_t k) noexcept { return (k + 1) % 4; }

  std::size_t nodes() const noexcept { return corners_ + grid_.size(); }
  std::size_t corners() const noexcept { return corners_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  Nodes nodesOf(maps::Cell cell) const noexcept {
    const auto column = static_cast<std::size_t>(cell.column), row = static_cast<std::size_t>(cell.row);
    const std::size_t south_west = row * (width_ + 1) + column;
    const auto node = [](std::size_t k) { return static_cast<std::uint32_t>(k); };
    return {node(south_west), node(south_west + 1), node(south_west + width_ + 2),
            node(south_west + width_ + 1), node(corners_ + row * width_ + column)};
  }

  /// For a corner node its column and row among corners, for a middle those of its cell.
  maps::Cell positionOf(std::uint32_t node) const noexcept {
    const std::size_t columns = node < corners_ ? width_ + 1 : width_;
    const std::size_t index = node < corners_ ? node : node - corners_;
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }

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
