#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/bound/directional_cost_bounds.hpp>

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

/// Costs by heading of the cells of a map (TriangleCosts), computed at the first request. Each cell that
/// allows some heading has a slot number; other data of the cell are also stored by this number. Not
/// thread-safe.
class MeshCosts {
 public:
  /// `limits` are those of the map's cost function. Cells outside `region`, by index of the cell, are closed; empty:
  /// none. Both must outlive the object.
  MeshCosts(std::shared_ptr<const costmap::CostGrid> map, DirectionalCostBounds& limits,
            const std::vector<bool>& region);

  /// Slot number of a cell without a slot.
  static constexpr std::uint32_t kNone = 0xffffffffU;

  const CellMesh& mesh() const noexcept { return mesh_; }
  /// Returns the slot of a cell, which is created if necessary; kNone outside the map and the region
  /// and for cells that allow no heading.
  std::uint32_t slotOf(maps::Cell cell);
  /// Returns the slot of a cell if slotOf() was called for the cell before; otherwise kNone.
  std::uint32_t knownSlotOf(maps::Cell cell) const noexcept;
  /// Returns the costs of the cell with a slot.
  const TriangleCosts& of(std::uint32_t slot) const noexcept { return prices_[slots_[slot].prices]; }
  /// Returns the cell with a slot.
  maps::Cell cellOf(std::uint32_t slot) const noexcept { return slots_[slot].cell; }
  /// Returns the number of slots.
  std::size_t slots() const noexcept { return slots_.size(); }

 private:
  struct Slot {
    std::uint32_t prices;
    maps::Cell cell;
  };
  // Most recent cell code with a given hash value, and its costs. Neighbouring cells often have equal codes.
  struct Recent {
    std::uint64_t code = 0;
    std::uint32_t prices = kNone;
  };

  std::uint32_t newPrices(costmap::CellCode code);

  std::shared_ptr<const costmap::CostGrid> map_;
  CellMesh mesh_;
  DirectionalCostBounds& limits_;
  const std::vector<bool>& region_;
  std::vector<std::uint32_t> slot_of_;  // slot by cell index
  std::vector<Slot> slots_;
  std::vector<TriangleCosts> prices_;
  std::vector<Recent> recent_;  // by hash value of the cell code
};

}  // namespace talus::planner
