#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/heading_limits.hpp>
#include <talus/planner/bound/triangle_prices.hpp>
#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// A function over the nodes of a CellMesh, linear on each triangle, that comes close to the cost to the goal from
/// below: no metre along any heading takes more of it than the HeadingLimits of its cell. Then no route between two
/// places, of any shape, costs less than the function falls between them. What it proves, provenBy() verifies.
///
/// How (ours). A search from the goal gives each node the least that the triangles about it allow, over the headings
/// to the side opposite of the node (the update of Tsitsiklis 1995 [tsitsiklis_1995], label correcting, since costs
/// depend on headings). Where the function rises from a node to two sides at once, as it does around the goal, around
/// corners of obstacles and beside ways that are cheaper than the ground about them, it exceeds the limits of
/// headings that lead to the node. There the prices of the triangle are lowered by the excess, and what follows from
/// them is searched again. This is done behind the front, every kBand nodes, so that what lies ahead is searched from
/// values that hold.
class SubSolution {
 public:
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    Segment places;
    double goal_tolerance_m = 0.0;
    double known_J;     ///< of some route: no dearer one matters; infinite where none is known
    double cheapest_J;  ///< of a metre, anywhere on the map, > 0
  };

  /// Searches at once.
  SubSolution(const Parts& parts, const StopCheck& stop);

  /// False when stopped.
  bool complete() const noexcept { return complete_; }

  static constexpr float kFar = 1e30F;  ///< of a node that was not reached

  const CellMesh& mesh() const noexcept { return mesh_; }
  float at(std::uint32_t node) const noexcept { return values_[node]; }
  /// The solution consists of the triangles that have an inner node.
  bool inner(std::uint32_t node) const noexcept { return expanded_[node] < kFar; }
  /// Prices of the cell; null where the search did not come, and where no heading is allowed.
  const TrianglePrices* pricesOf(maps::Cell cell) const noexcept;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  struct Slot {
    std::uint32_t prices;
    std::array<float, 4> share{1.0F, 1.0F, 1.0F, 1.0F};  // of the prices, by triangle and node
    bool changed = false;
    maps::Cell cell;
  };
  // A code and the prices of it, which neighbouring cells often share.
  struct Recent {
    std::uint32_t bits = 0, prices = kNone;
  };
  struct Lowered {
    std::uint32_t slot, triangle;
  };

  std::size_t indexOf(maps::Cell cell) const noexcept {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(mesh_.grid().width) +
           static_cast<std::size_t>(cell.column);
  }
  Slot* slotOf(maps::Cell cell);
  std::uint32_t newPrices(costmap::CellCode code);
  void seedDisc();
  void seedPlane();
  bool search(std::uint64_t end, std::size_t quota);
  void expand(std::uint32_t node);
  void fromCorner(maps::Cell cell, std::size_t corner);
  void fromMiddle(maps::Cell cell);
  void lower(std::uint32_t node, float value);
  bool settle(std::uint64_t end);
  bool lowerPrices(bool all);
  void search(const Lowered& triangle);
  void change(std::uint32_t slot);
  void changeAround(std::uint32_t node);
  double restFrom(std::uint32_t node) const;

  Parts parts_;
  CellMesh mesh_;
  StopCheck stop_;
  HeadingLimits limits_;
  std::vector<float> values_, expanded_;  // expanded_: the value with which a node was last expanded
  std::vector<std::uint32_t> slot_of_;    // by cell
  std::vector<Slot> slots_;
  std::vector<TrianglePrices> prices_;
  std::vector<Recent> recent_;  // by hash
  // Slots of which values changed since they were checked; those with triangles ahead of the front.
  std::vector<std::uint32_t> changed_, ahead_;
  BucketQueue queue_;
  double unit_J_, base_J_ = 0.0, most_J_;
  std::uint64_t front_ = 0, lowest_ = 0;  // keys: how far the search came, and the lowest that is queued
  std::size_t taken_ = 0;
  bool complete_ = false;
};

}  // namespace talus::planner
