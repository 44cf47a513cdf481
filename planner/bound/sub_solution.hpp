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

/// Subsolution of the Hamilton-Jacobi equation of the cost function: a function over the nodes of a CellMesh,
/// linear on each triangle, that approximates the cost to the goal from below. Along every heading the
/// function changes per metre by at most the DirectionalCostBounds of the cell. Therefore no route between
/// two points, of any shape, costs less than the difference of the values of the function at both points.
/// provenBy() verifies the resulting bound.
///
/// Method (ours, not from the literature). A search from the goal gives each node the lowest value that the
/// adjacent triangles allow, over the headings from the node to the opposite side. At some nodes the function
/// rises towards two sides at once: around the goal, around corners of obstacles and beside corridors of low
/// cost. There, along headings from a side to the opposite node, the function decreases by more than the
/// cost. The end values of such a side are capped relative to the opposite node (a lower cap of one end
/// permits a higher cap of the other end), and the affected nodes are searched again. Of the admissible pairs
/// of caps, the pair closest to the values of a search from the start is used, because that search satisfies
/// the same limits. Caps are added behind the front of the search after every kBand nodes, so that the search
/// continues from valid values.
///
/// Both searches stay in a region that no route of at most the known cost leaves; the region of the second may
/// be smaller.
class SubSolution {
 public:
  /// Input of the search.
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    /// Start and goal of the routes [m].
    Segment places;
    double goal_tolerance_m = 0.0;  ///< permitted distance of the end of a route from the goal [m]
    /// Cost of a known route [J]; more expensive routes are ignored; infinite if none is known.
    double known_J;
    double cheapest_J;  ///< lower bound of the cost per metre on the whole map [J/m], > 0
  };

  /// Runs the search from the start for at most `quota` nodes. `region` is true for the cells of the region,
  /// by index of the cell; empty: all cells. `limits` are those of the map's cost function and must outlive
  /// the object.
  SubSolution(const Parts& parts, DirectionalCostBounds& limits, std::vector<bool> region, std::size_t quota,
              const StopCheck& stop);

  /// Runs the search from the goal in `region`, for at most `quota` nodes.
  void solve(std::vector<bool> region, std::size_t quota);

  /// Returns false if a stop or a quota ended a search.
  bool complete() const noexcept { return complete_; }

  /// Returns the cost from the start to a node [J] by the first search; kFar for a node not reached.
  float fromStart(std::uint32_t node) const noexcept { return from_start_.at(node); }

  static constexpr float kFar = MeshSearch::kFar;  ///< value of a node that was not reached

  const CellMesh& mesh() const noexcept { return prices_.mesh(); }
  /// Returns the value of the function at a node [J].
  float at(std::uint32_t node) const noexcept { return to_goal_.at(node); }
  /// Returns true for an inner node, that is, a node that the search expanded. The solution consists of the
  /// triangles with at least one inner node.
  bool inner(std::uint32_t node) const noexcept { return to_goal_.expanded(node); }
  /// Returns the lower bounds of the costs by heading of a cell; null for cells that were not searched and
  /// for cells that allow no heading.
  const TriangleCosts* pricesOf(maps::Cell cell) const noexcept;

  /// Returns the near-optimal route from start to goal over all headings, without costs of turns
  /// (meshRoute()).
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
