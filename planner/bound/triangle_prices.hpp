#pragma once

#include <array>

#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/heading_limits.hpp>

namespace talus::planner {

/// What a side's length of a cell costs at least by heading, and what follows for a function that is linear on each
/// of the cell's triangles (CellMesh). Triangles are numbered by their first corner.
struct TrianglePrices {
  static constexpr std::size_t kStored = HeadingLimits::kHeadings + 12;
  std::array<float, kStored> prices;  ///< the first ones again at the end

  TrianglePrices(const HeadingLimits::Limits& limits, double side_m) noexcept;

  /// Values of a triangle's nodes.
  struct Values {
    float first, second, middle;
  };

  /// The most that one node may have, the other two being as they are: the least over the headings from it to the
  /// side opposite, both ends included, of the value there and `share` of the way's price.
  float first(std::size_t triangle, float share, const Values& values) const noexcept;
  float second(std::size_t triangle, float share, const Values& values) const noexcept;
  float middle(std::size_t triangle, float share, const Values& values) const noexcept;

  /// By how much a side's length falls along x and y.
  static costmap::Direction fall(std::size_t triangle, const Values& values) noexcept;
  /// Whether some heading falls more than `share` of its price.
  bool exceeds(const costmap::Direction& fall, float share) const noexcept;
  /// The largest ratio of a heading's fall and its price, of all headings.
  float excess(const costmap::Direction& fall) const noexcept;
  /// The same of those from a node of the triangle to the side opposite.
  float excessFromNodes(std::size_t triangle, const costmap::Direction& fall) const noexcept;
};

}  // namespace talus::planner
