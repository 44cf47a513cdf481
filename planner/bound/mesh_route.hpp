#pragma once

#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Returns a route from `places.from` to `places.to`, traced cell by cell in the direction of decreasing
/// values of the search `from_start`, which began at `places.from`. Each step follows one of 64 headings or
/// leads to a corner, and has its exact cost. The route is near the optimum over all headings and is meant to
/// be refined; costs of turns are not included. The result is empty if there is no allowed route of this
/// kind.
Polyline meshRoute(const MotionCost& cost, const MeshSearch& from_start, const CellMesh& mesh,
                   const Segment& places);

}  // namespace talus::planner
