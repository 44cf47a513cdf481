#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/bound/fitted_octagon.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/stop_check.hpp>

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
  /// `limits` are those of the map's cost function and must outlive the object.
  MeshCosts(std::shared_ptr<const costmap::CostGrid> map, DirectionalCostBounds& limits);

  /// Slot number of a cell without a slot.
  static constexpr std::uint32_t kNone = 0xffffffffU;

  const CellMesh& mesh() const noexcept { return mesh_; }
  /// Returns the slot of a cell, which is created if necessary; kNone outside the map and for cells that allow
  /// no heading.
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
  std::uint32_t newPrices(costmap::CellCode code);

  std::shared_ptr<const costmap::CostGrid> map_;
  CellMesh mesh_;
  DirectionalCostBounds& limits_;
  std::vector<std::uint32_t> slot_of_;  // slot by cell index
  std::vector<Slot> slots_;
  std::vector<TriangleCosts> prices_;
  std::unordered_map<std::uint64_t, std::uint32_t> prices_of_;  // position in prices_ by cell code
};

/// Search for the highest function over the nodes of a CellMesh that is linear on each triangle and satisfies
/// the cost limits. Along each motion between a node and the opposite side of a triangle the function
/// decreases by at most the cost of the motion. The direction of the motions is given by Options::way. The
/// search is label-correcting (a node may be expanded several times), because costs depend on the heading,
/// with the update of Tsitsiklis 1995 [tsitsiklis_1995]. Not thread-safe.
class MeshSearch {
 public:
  using Way = TriangleCosts::Way;

  struct Options {
    /// Direction of the motions: from a node to the opposite side, or from the side to the node.
    Way way = Way::FromNode;
    double cheapest_J;  ///< lower bound of the cost per metre on the whole map, > 0
    /// Lower bounds of the costs between the other end of the routes and the corners [J] by node number, linear
    /// along cell sides; null: 0. Must outlive the search.
    const std::vector<float>* rest = nullptr;
    /// Cost limit [J]: nodes that lie on no route of at most this cost are not expanded.
    double most_J = std::numeric_limits<double>::infinity();
  };

  MeshSearch(MeshCosts& prices, const Options& options);

  static constexpr float kFar = 1e30F;  ///< value of a node that was not reached
  /// Queue key that means "no limit".
  static constexpr std::uint64_t kEnd = ~std::uint64_t{0};

  /// Returns the value of a node [J].
  float at(std::uint32_t node) const noexcept { return values_[node]; }
  /// Returns true if the node was expanded.
  bool expanded(std::uint32_t node) const noexcept { return expanded_[node] < kFar; }
  /// Sets the value [J] that has the queue key 0. Nodes with lower values are expanded in any order.
  void startAt(double base_J) noexcept { base_J_ = base_J; }
  /// Reduces the value of a node to `value` [J]. Returns false, without a change, if the reduction is below
  /// 1e-3 queue units.
  bool lower(std::uint32_t node, float value);

  /// Expands nodes up to the queue key `end`, or until `quota` nodes have been expanded in total. Returns
  /// false if a stop ended the search.
  bool run(std::uint64_t end, std::size_t quota, const StopCheck& stop);
  /// Returns a lower bound [J] of the cost between the other end of the routes and every point of a cell: the lowest
  /// of Options::rest at its corners.
  float restIn(maps::Cell cell) const noexcept;
  /// Returns true if no node is queued.
  bool done() const noexcept { return queue_.queued() == 0; }
  /// Returns the number of expansions.
  std::size_t taken() const noexcept { return taken_; }
  std::uint64_t front() const noexcept { return front_; }  ///< returns the highest queue key reached

  /// Caps of a triangle: the largest allowed difference of the values of two of its nodes (first corner,
  /// second corner, centre = middle), in the order first - second, first - middle, second - first, second -
  /// middle, middle - first, middle - second.
  using Caps = std::array<float, 6>;
  /// Returns the position in Caps of the difference `node` - `above`.
  static constexpr std::size_t capOf(std::size_t node, std::size_t above) noexcept {
    return 2 * node + (above < node ? above : above - 1);
  }
  /// Adds caps for the two other nodes of a triangle relative to the node `above`. `slot` is the slot of the
  /// cell in MeshCosts.
  void cap(std::uint32_t slot, std::size_t triangle, std::size_t above, const TriangleCosts::Rise& rise);
  /// Reduces the values of the nodes of a triangle to the limits given by its costs and caps. Returns true if
  /// a value was reduced.
  bool relax(std::uint32_t slot, std::size_t triangle);

  /// Returns the slots of the cells whose values changed since the previous call.
  std::vector<std::uint32_t> takeChanged();
  /// Marks the cell with a slot as changed.
  void change(std::uint32_t slot);

 private:
  struct Cell {
    std::array<Caps, 4> caps;
    bool capped = false, changed = false;
    Cell() {
      for (Caps& of : caps) of.fill(kFar);
    }
  };

  double rest(std::uint32_t node) const noexcept;
  void expand(std::uint32_t node);
  void fromCorner(maps::Cell cell, std::size_t corner);
  void fromMiddle(maps::Cell cell);
  void changeAround(std::uint32_t node);

  MeshCosts& prices_;
  Options options_;
  std::vector<float> values_, expanded_;  // expanded_: value of the node at its latest expansion
  std::vector<Cell> cells_;               // by slot
  std::vector<std::uint32_t> changed_;
  BucketQueue queue_;
  double unit_J_, base_J_ = 0.0;
  std::uint64_t front_ = 0, lowest_ = 0;  // keys: highest reached and lowest queued
  std::size_t taken_ = 0;
};

}  // namespace talus::planner
