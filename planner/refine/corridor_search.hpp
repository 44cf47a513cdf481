#pragma once

#include <vector>

#include <talus/planner/field/cost_range.hpp>
#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/refine/edge_path.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

struct CorridorOptions {
  int reach_cells = 4;      ///< how far from the given way the search may go
  int points_per_edge = 3;  ///< where a cell's edge may be crossed
  Kernels kernels = Kernels::Best;
};

/// Searches for the cheapest way between the ends of a polyline that crosses cells' edges at a few fixed
/// points and stays near the polyline: Dijkstra's search over those points. It leaves a point into the other
/// cell only, so it does not look for ways that turn back off an edge, and every turn is one that both cells
/// beside it allow. Immutable, safe to share between threads; the MotionCost must outlive it.
class CorridorSearch {
 public:
  explicit CorridorSearch(const MotionCost& cost, const CorridorOptions& options = {});

  /// Empty when there is no way cheaper than `below_J`. The polyline must lie inside the map.
  EdgePath operator()(const std::vector<maps::Point>& along, double below_J) const;

 private:
  const MotionCost& cost_;
  CorridorOptions options_;
  EdgeCrossings crossings_;
  CostRange range_;
};

/// One search, once.
EdgePath searchCorridor(const MotionCost& cost, const std::vector<maps::Point>& along, double below_J,
                        const CorridorOptions& options = {});

}  // namespace talus::planner
