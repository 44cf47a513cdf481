#pragma once

#include <talus/planner/bound/mesh_search.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// A way between two places down a search from the first of them, cell by cell, in 64 headings and towards corners, under
/// the exact cost: near the cheapest of all headings. To be refined; turns are left out. Empty where the search leads
/// nowhere that may be driven.
Polyline meshRoute(const MotionCost& cost, const MeshSearch& from_start, const CellMesh& mesh,
                   const Segment& places);

}  // namespace talus::planner
