#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/directional_cost_bounds.hpp>

namespace talus::planner {

/// Lower bounds, by heading, of the cost [J] of a motion as long as one cell side, and the resulting limits
/// for a function that is linear on each triangle of a cell (CellMesh). Triangles are numbered by their first
/// corner.
struct TriangleCosts {
  static constexpr std::size_t kStored = DirectionalCostBounds::kHeadings + 12;
  std::array<float, kStored> prices;  ///< lower bounds by heading; the first 12 are repeated at the end

  /// Direction of the motions: from a node to the opposite side of the triangle, or from the side to the
  /// node.
  enum class Way : std::uint8_t { FromNode, ToNode };

  /// `limits` are the costs per metre of the cell, `side_m` is the side length of the cell.
  TriangleCosts(const DirectionalCostBounds::Limits& limits, double side_m) noexcept;

  /// Values [J] of the function at the three nodes of a triangle: first corner, second corner, and centre.
  struct Values {
    float first, second, middle;
  };

  /// Returns the largest value that one node may have for given values of the other two nodes. It is the
  /// minimum, over the motions between the node and the opposite side (ends included), of the value on the
  /// side plus the cost of the motion. Motions lead from the node to the side, or for Way::ToNode from the
  /// side to the node.
  float first(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float second(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float middle(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;

  /// Largest differences of the values of the two opposite nodes and the value of a node [J].
  struct Rise {
    float a, b;
  };
  /// Returns limits for the ends of the side opposite to `node`, relative to the value of this node, such
  /// that on no motion from the side to the node the function decreases by more than the cost. The result is
  /// empty if no motion exceeds its cost. No limit exceeds the present difference. Of all admissible pairs of
  /// limits, the pair whose first limit is closest to `wanted` is returned; the two ends are in the order of
  /// Values.
  std::optional<Rise> lowered(std::size_t triangle, std::size_t node, const Values& values, float wanted,
                              float slack) const noexcept;

  /// Returns the decrease of the function over one cell side length in the directions of x and y [J].
  static costmap::Direction fall(std::size_t triangle, const Values& values) noexcept;
  /// Returns true if the decrease along some heading exceeds `share` times the cost of the heading.
  bool exceeds(const costmap::Direction& fall, float share) const noexcept;
};

}  // namespace talus::planner
