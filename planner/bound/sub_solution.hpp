#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/polyline.hpp>
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
/// of caps, the pair closest to the values of a search from the start is used, because that search satisfies the
/// same limits.
/// Caps are added behind the front of the search after every kBand nodes, so that the search continues from
/// valid values and may end anywhere.
class SubSolution {
 public:
  /// Input of the search.
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    /// Start and goal of the routes [m].
    Segment places;
    double goal_tolerance_m = 0.0;  ///< permitted distance of the end of a route from the goal [m]
    double most_J;                  ///< more expensive routes are ignored [J]; may be infinite
    double cheapest_J;              ///< lower bound of the cost per metre on the whole map [J/m], > 0
    /// Lower bounds of the costs from the start to the corners of the mesh [J], linear along cell sides (cornerField()).
    std::vector<float> from_start;
  };

  /// Takes nodes and checks cells at most `quota` times in all. `limits` are those of the map's cost function; both must outlive the object.
  SubSolution(const Parts& parts, DirectionalCostBounds& limits, std::size_t quota, const StopCheck& stop);

  /// Returns a lower bound of the costs from the start to every point of a cell.
  float fromStartIn(maps::Cell cell) const noexcept { return to_goal_.restIn(cell); }

  /// Returns the number of nodes taken and cells checked.
  std::size_t work() const noexcept { return from_start_.taken() + to_goal_.taken() + checked_; }

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

 private:
  void seedDisc();
  void seedPlane();
  void seedStart();
  bool settle(bool all);
  bool lowerExcess(bool all);
  void cap(std::uint32_t slot, std::size_t triangle);

  const Parts& parts_;
  StopCheck stop_;
  std::size_t quota_, checked_ = 0;
  MeshCosts prices_;
  MeshSearch from_start_, to_goal_;
};

/// Lower bound proven by a sub-solution.
struct Proof {
  double bound_J = 0.0;  ///< lower bound of the cost of every route from the start to the goal [J]
  double excess = 1.0;   ///< smallest factor >= 1 such that the solution divided by it satisfies every limit
};

/// Verifies a sub-solution against the limits of its cells and at its border. Returns a bound of 0 if nothing
/// is proven.
///
/// Proof (ours, not from the literature). For all triangles of the solution u and all 64 headings, let w be
/// the largest ratio of the decrease of u per metre to the limit of the cell. Then u / w satisfies all
/// limits; therefore a route costs at least (u(p) - u(goal)) / w behind a place p after which it stays on these
/// triangles. If it does not stay on them from the start on, p is on a side with two outer nodes (nodes that the
/// search did not expand), and the route costs at least the lower bound from the start before p. A search that
/// ended early thus extends the bounds from the start by the part near the goal that it reached.
Proof provenBy(const SubSolution& solution, const SubSolution::Parts& parts);

}  // namespace talus::planner
