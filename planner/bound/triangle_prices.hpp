#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/heading_limits.hpp>

namespace talus::planner {

/// What a side's length of a cell costs at least by heading, and what follows for a function that is linear on each
/// of the cell's triangles (CellMesh). Triangles are numbered by their first corner.
struct TrianglePrices {
  static constexpr std::size_t kStored = HeadingLimits::kHeadings + 12;
  std::array<float, kStored> prices;  ///< the first ones again at the end

  enum class Way : std::uint8_t { FromNode, ToNode };

  TrianglePrices(const HeadingLimits::Limits& limits, double side_m) noexcept;

  /// Values of a triangle's nodes.
  struct Values {
    float first, second, middle;
  };

  /// The most that one node may have, the other two being as they are: the least over the ways between it and the
  /// side opposite, both ends included, of the value there and the way's price; from the node to the side, or, with
  /// Way::ToNode, from the side to the node.
  float first(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float second(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float middle(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;

  /// Of the two nodes opposite of a node: the most that they may lie above it.
  struct Rise {
    float a, b;
  };
  /// Where some way from the side opposite to a node falls by more than its price: what the side's ends, in the order of
  /// Values, may lie above the node so that none does, no more than they do; of all such pairs the one in which the first
  /// end comes nearest to `wanted` of it.
  std::optional<Rise> lowered(std::size_t triangle, std::size_t node, const Values& values, float wanted,
                              float slack) const noexcept;

  /// By how much a side's length falls along x and y.
  static costmap::Direction fall(std::size_t triangle, const Values& values) noexcept;
  /// Whether some heading falls more than `share` of its price.
  bool exceeds(const costmap::Direction& fall, float share) const noexcept;
};

}  // namespace talus::planner
