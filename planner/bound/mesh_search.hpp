#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <talus/planner/bound/mesh_prices.hpp>
#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The highest function over the nodes of a CellMesh, linear on each triangle, that from no node to the side opposite falls by
/// more than the way's price, or from no side to the node opposite: label correcting, since prices depend on headings, by the
/// update of Tsitsiklis 1995 [tsitsiklis_1995]. Not thread-safe.
class MeshSearch {
 public:
  using Way = TrianglePrices::Way;

  struct Options {
    Way way = Way::FromNode;
    double cheapest_J;  ///< of a metre, anywhere on the map, > 0
    maps::Point other;  ///< where routes come from, or where they go
    double most_J;      ///< nodes from which no route of less gets there are not searched
  };

  MeshSearch(MeshPrices& prices, const Options& options);

  static constexpr float kFar = 1e30F;  ///< of a node that was not reached
  static constexpr std::uint64_t kEnd = ~std::uint64_t{0};

  float at(std::uint32_t node) const noexcept { return values_[node]; }
  bool expanded(std::uint32_t node) const noexcept { return expanded_[node] < kFar; }
  /// From which value on nodes are taken in order.
  void startAt(double base_J) noexcept { base_J_ = base_J; }
  /// A node may have no more than this; whether it had, by what matters.
  bool lower(std::uint32_t node, float value);

  /// Searches up to a key, or until so many nodes are taken in all; false when stopped.
  bool run(std::uint64_t end, std::size_t quota, const StopCheck& stop);
  bool done() const noexcept { return queue_.queued() == 0; }
  std::size_t taken() const noexcept { return taken_; }
  std::uint64_t front() const noexcept { return front_; }  ///< the key that it came to

  /// What one node of a triangle may lie above another: first above second, first above middle, second above first, second
  /// above middle, middle above first, middle above second.
  using Caps = std::array<float, 6>;
  static constexpr std::size_t capOf(std::size_t node, std::size_t above) noexcept {
    return 2 * node + (above < node ? above : above - 1);
  }
  /// Caps the two others from now on.
  void cap(std::uint32_t slot, std::size_t triangle, std::size_t above, const TrianglePrices::Rise& rise);
  /// Lowers the nodes of a triangle as its prices and caps have it; whether that lowered any.
  bool relax(std::uint32_t slot, std::size_t triangle);

  /// Slots of which values changed since they were last asked for.
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
  void changed(std::uint32_t slot);

  MeshPrices& prices_;
  Options options_;
  std::vector<float> values_, expanded_;  // expanded_: the value with which a node was last expanded
  std::vector<Cell> cells_;               // by slot
  std::vector<std::uint32_t> changed_;
  BucketQueue queue_;
  double unit_J_, base_J_ = 0.0;
  std::uint64_t front_ = 0, lowest_ = 0;  // keys: how far the search came, and the lowest that is queued
  std::size_t taken_ = 0;
};

}  // namespace talus::planner
