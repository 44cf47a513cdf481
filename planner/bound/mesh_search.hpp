#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <talus/planner/bound/mesh_costs.hpp>
#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

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
