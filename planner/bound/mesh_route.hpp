#pragma once

#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Traces a route between two places by descending a search from the first place, cell by cell. Each step
/// follows one of 64 headings or leads to a corner, and has its exact cost. The route is near the optimum
/// over all headings and is meant to be refined; turn costs are not included. Empty if no allowed descent
/// exists.
Polyline meshRoute(const MotionCost& cost, const MeshSearch& from_start, const CellMesh& mesh,
                   const Segment& places);

}  // namespace talus::planner
