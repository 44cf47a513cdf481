#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <talus/planner/bound/mesh_costs.hpp>
#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Computes the highest function over the nodes of a CellMesh, linear on each triangle, whose fall from each
/// node to the opposite side (or from each side to the opposite node) is at most the cost of the motion.
/// Label-correcting, because costs depend on the heading, with the update of Tsitsiklis 1995
/// [tsitsiklis_1995]. Not thread-safe.
class MeshSearch {
 public:
  using Way = TriangleCosts::Way;

  struct Options {
    Way way = Way::FromNode;
    double cheapest_J;  ///< lower bound of the cost per metre on the whole map, > 0
    maps::Point other;  ///< the other end of the routes: start or goal
    double most_J;      ///< nodes on no route of at most this cost are not expanded [J]
  };

  MeshSearch(MeshCosts& prices, const Options& options);

  static constexpr float kFar = 1e30F;  ///< value of a node that was not reached
  static constexpr std::uint64_t kEnd = ~std::uint64_t{0};

  float at(std::uint32_t node) const noexcept { return values_[node]; }
  bool expanded(std::uint32_t node) const noexcept { return expanded_[node] < kFar; }
  /// Sets the value [J] of queue key 0. Nodes with lower values are expanded in any order.
  void startAt(double base_J) noexcept { base_J_ = base_J; }
  /// Lowers a node to `value`. Returns false, without a change, if the reduction is below 1e-3 queue units.
  bool lower(std::uint32_t node, float value);

  /// Searches up to the key `end`, or until `quota` nodes have been taken in total. Returns false when
  /// stopped.
  bool run(std::uint64_t end, std::size_t quota, const StopCheck& stop);
  bool done() const noexcept { return queue_.queued() == 0; }
  std::size_t taken() const noexcept { return taken_; }
  std::uint64_t front() const noexcept { return front_; }  ///< highest key reached

  /// Largest allowed difference of two nodes of a triangle: first - second, first - middle, second - first,
  /// second - middle, middle - first, middle - second.
  using Caps = std::array<float, 6>;
  static constexpr std::size_t capOf(std::size_t node, std::size_t above) noexcept {
    return 2 * node + (above < node ? above : above - 1);
  }
  /// Adds caps for the two other nodes of a triangle relative to node `above`.
  void cap(std::uint32_t slot, std::size_t triangle, std::size_t above, const TriangleCosts::Rise& rise);
  /// Lowers the nodes of a triangle to its costs and caps. Returns true if any node was lowered.
  bool relax(std::uint32_t slot, std::size_t triangle);

  /// Slots whose values changed since the previous call.
  std::vector<std::uint32_t> takeChanged();
  void change(std::uint32_t slot);

 private:
  struct Cell {
    std::array<Caps, 4> caps;
    bool capped = false, changed = false;
    Cell() {
      for (Caps& of : caps) of.fill(kFar);
    }
  };

  double restFrom(std::uint32_t node) const;
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
