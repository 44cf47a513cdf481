#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/planner/bound/mesh_costs.hpp>
#include <talus/planner/bound/mesh_route.hpp>
#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Subsolution of the Hamilton-Jacobi equation of the drive cost: a function over the nodes of a CellMesh,
/// linear on each triangle, that approximates the cost to the goal from below. Along every heading the
/// function changes per metre by at most the DirectionalCostBounds of the cell. No route between two places,
/// of any shape, then costs less than the difference of the function's values. provenBy() verifies the
/// resulting bound.
///
/// Method (ours, not from the literature). A search from the goal gives each node the lowest value that the
/// adjacent triangles allow, over the headings from the node to the opposite side. At some nodes the function
/// rises towards two sides at once: around the goal, around corners of obstacles and beside corridors of low
/// cost. There, headings from a side to the opposite node fall by more than their cost. The end values of
/// such a side are capped relative to the opposite node (a lower cap of one end permits a higher cap of the
/// other), and the affected nodes are searched again. Of the admissible pairs of caps, the pair closest to
/// the values of a search from the start is taken, because that search respects the same limits. Caps are
/// added behind the front after every kBand nodes, so that the search ahead starts from valid values.
class SubSolution {
 public:
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    Segment places;
    double goal_tolerance_m = 0.0;
    double known_J;     ///< cost of a known route: costlier routes are ignored; infinite if none is known
    double cheapest_J;  ///< lower bound of the cost per metre on the whole map, > 0
  };

  /// Runs the search.
  SubSolution(const Parts& parts, const StopCheck& stop);

  /// False when stopped.
  bool complete() const noexcept { return complete_; }

  static constexpr float kFar = MeshSearch::kFar;  ///< value of a node that was not reached

  const CellMesh& mesh() const noexcept { return prices_.mesh(); }
  float at(std::uint32_t node) const noexcept { return to_goal_.at(node); }
  /// True for an expanded node. The solution consists of the triangles with an inner node.
  bool inner(std::uint32_t node) const noexcept { return to_goal_.expanded(node); }
  /// Returns the cost lower bounds by heading of a cell; null for cells not searched and cells without an
  /// allowed heading.
  const TriangleCosts* pricesOf(maps::Cell cell) const noexcept;

  /// Near-optimal route from start to goal over all headings, without turn costs; see meshRoute().
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
  MeshCosts prices_;
  MeshSearch from_start_, to_goal_;
  bool complete_ = false;
};

}  // namespace talus::planner
