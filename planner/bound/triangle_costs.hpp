#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/directional_cost_bounds.hpp>

namespace talus::planner {

/// Lower bounds [J] of the cost of a motion as long as one cell side, by heading, and the resulting limits
/// for a function that is linear on each triangle of the cell (CellMesh). Triangles are numbered by their
/// first corner.
struct TriangleCosts {
  static constexpr std::size_t kStored = DirectionalCostBounds::kHeadings + 12;
  std::array<float, kStored> prices;  ///< by heading; the first 12 are repeated at the end

  enum class Way : std::uint8_t { FromNode, ToNode };

  TriangleCosts(const DirectionalCostBounds::Limits& limits, double side_m) noexcept;

  /// Values [J] of the linear function at the three nodes of a triangle.
  struct Values {
    float first, second, middle;
  };

  /// Returns the largest value that one node may have for given values of the other two: the minimum, over
  /// the motions between the node and the opposite side (ends included), of the value on the side plus the
  /// motion's cost. Motions lead from the node to the side, or with Way::ToNode from the side to the node.
  float first(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float second(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;
  float middle(std::size_t triangle, const Values& values, Way way = Way::FromNode) const noexcept;

  /// Largest rise of the two opposite nodes above a node.
  struct Rise {
    float a, b;
  };
  /// Limits of a side's ends above the opposite node such that no motion from the side to the node falls by
  /// more than its cost. Empty if no motion exceeds its cost. Neither limit exceeds the present rise. Of all
  /// admissible pairs, the pair whose first end is closest to `wanted` is returned; ends are in the order of
  /// Values.
  std::optional<Rise> lowered(std::size_t triangle, std::size_t node, const Values& values, float wanted,
                              float slack) const noexcept;

  /// Fall over one cell side along x and y.
  static costmap::Direction fall(std::size_t triangle, const Values& values) noexcept;
  /// Returns true if the fall along some heading exceeds `share` times its cost.
  bool exceeds(const costmap::Direction& fall, float share) const noexcept;
};

}  // namespace talus::planner
