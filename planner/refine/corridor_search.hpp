#pragma once

#include <vector>

#include <talus/planner/field/cost_range.hpp>
#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/refine/edge_path.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

/// Parameters of the search.
struct CorridorOptions {
  int reach_cells = 4;      ///< largest distance of the path from the given polyline [cells]
  int points_per_edge = 3;  ///< number of points per cell edge at which the path may cross the edge
  Kernels kernels = Kernels::Best;
};

/// Search of the cheapest path between the ends of a polyline that stays near the polyline and crosses cell
/// edges at a few fixed points. The method is Dijkstra's algorithm over these points. From a point on an edge
/// the path leads only into the other cell; therefore paths that turn back at an edge are not searched, and
/// both adjacent cells allow every turn. Immutable and safe to share between threads; the MotionCost must
/// outlive the object.
class CorridorSearch {
 public:
  explicit CorridorSearch(const MotionCost& cost, const CorridorOptions& options = {});

  /// Returns the cheapest path near the polyline `along`, which must lie inside the map; empty if no path
  /// costs less than `below_J` [J].
  EdgePath operator()(const std::vector<maps::Point>& along, double below_J) const;

 private:
  const MotionCost& cost_;
  CorridorOptions options_;
  EdgeCrossings crossings_;
  CostRange range_;
};

/// Runs a single search with a temporary CorridorSearch.
EdgePath searchCorridor(const MotionCost& cost, const std::vector<maps::Point>& along, double below_J,
                        const CorridorOptions& options = {});

}  // namespace talus::planner
