#pragma once

#include <vector>

#include <talus/planner/field/cost_range.hpp>
#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/refine/edge_path.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

struct CorridorOptions {
  int reach_cells = 4;      ///< largest distance of the search from the given path
  int points_per_edge = 3;  ///< number of crossing points of a cell's edge
  Kernels kernels = Kernels::Best;
};

/// Searches the cheapest path between the ends of a polyline that stays near the polyline and crosses cell
/// edges at a few fixed points, with Dijkstra's algorithm over these points. The path leaves a point only
/// into the other cell, so paths that turn back at an edge are not considered, and every turn is allowed by
/// both adjacent cells. Immutable and safe to share between threads; the MotionCost must outlive the object.
class CorridorSearch {
 public:
  explicit CorridorSearch(const MotionCost& cost, const CorridorOptions& options = {});

  /// Empty if no path costs less than `below_J`. The polyline must lie inside the map.
  EdgePath operator()(const std::vector<maps::Point>& along, double below_J) const;

 private:
  const MotionCost& cost_;
  CorridorOptions options_;
  EdgeCrossings crossings_;
  CostRange range_;
};

/// Runs a single search.
EdgePath searchCorridor(const MotionCost& cost, const std::vector<maps::Point>& along, double below_J,
                        const CorridorOptions& options = {});

}  // namespace talus::planner
