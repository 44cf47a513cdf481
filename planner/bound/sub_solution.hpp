#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/planner/bound/mesh_prices.hpp>
#include <talus/planner/bound/mesh_route.hpp>
#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// A function over the nodes of a CellMesh, linear on each triangle, that comes close to the cost to the goal from
/// below: no metre along any heading takes more of it than the HeadingLimits of its cell. Then no route between two
/// places, of any shape, costs less than the function falls between them. What it proves, provenBy() verifies.
///
/// How (ours). A search from the goal gives each node the least that the triangles about it allow, over the headings
/// to the side opposite of the node. Where the function rises from a node to two sides at once, as it does around the goal,
/// around corners of obstacles and beside ways that are cheaper than the ground about them, headings that lead from a side
/// to the node opposite fall by more than their price. There the ends of the side are capped, one the less the more the
/// other is, and what follows is searched again. Of the pairs of caps that hold the limits that one is taken which leaves
/// the way that routes from the start take: by a search from the start, whose level lines keep these very limits. This is
/// done behind the front, every kBand nodes, so that what lies ahead is searched from values that hold.
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

  static constexpr float kFar = MeshSearch::kFar;  ///< of a node that was not reached

  const CellMesh& mesh() const noexcept { return prices_.mesh(); }
  float at(std::uint32_t node) const noexcept { return to_goal_.at(node); }
  /// The solution consists of the triangles that have an inner node.
  bool inner(std::uint32_t node) const noexcept { return to_goal_.expanded(node); }
  /// Prices of the cell; null where the search did not come, and where no heading is allowed.
  const TrianglePrices* pricesOf(maps::Cell cell) const noexcept;

  /// A way from start to goal near the cheapest of all headings, turns left out, as meshRoute() has it.
  Polyline way() const { return meshRoute(MotionCost(parts_.map), from_start_, mesh(), parts_.places); }

 private:
  void seedDisc();
  void seedPlane();
  void seedStart();
  bool settle(bool all);
  bool lowerExcess(bool all);
  void cap(std::uint32_t slot, std::size_t triangle);

  Parts parts_;
  StopCheck stop_;
  MeshPrices prices_;
  MeshSearch from_start_, to_goal_;
  bool complete_ = false;
};

}  // namespace talus::planner
