#pragma once

#include <vector>

#include <planner/edge_path.hpp>
#include <planner/kernels.hpp>

namespace talus::planner {

struct CorridorOptions {
  int reach_cells = 3;      ///< how far from the given way the search may go
  int points_per_edge = 3;  ///< where a cell's edge may be crossed
  Kernels kernels = Kernels::Best;
};

/// The cheapest way between the ends of a polyline that crosses cells' edges at a few fixed points and stays
/// near the polyline: Dijkstra's search over those points. It leaves a point into the other cell only, so it
/// does not look for ways that turn back off an edge, and every turn is one that both cells beside it allow.
/// Empty when there is none cheaper than `below_J`. The polyline must lie inside the map.
EdgePath searchCorridor(const MotionCost& cost, const std::vector<maps::Point>& along, double below_J,
                        const CorridorOptions& options = {});

}  // namespace talus::planner
