#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Options of tubeRoute(); distances in cells.
struct TubeOptions {
  double margin_cells = 48.0;   ///< initial distance from the guide to the tube's border
  double leg_cells = 384.0;     ///< length of the legs in which the tube is searched
  double overlap_cells = 96.0;  ///< to either side of a joint of two legs, searched once more
  int widenings = 3;  ///< times that a leg's margin is doubled if its route touches the tube's border
};

/// Grid route from start to goal near a guide. Each leg of the guide is searched with the field of a box of
/// tiles around it, without the tiles outside the tube. A leg whose route touches the tube's border is
/// searched again in a wider tube; a leg without a route is joined with the next leg (the last leg with the
/// previous one). Memory holds the boxes of a few legs only. Empty if no route was found, which is no proof
/// that none exists, or when stopped. The guide runs from the problem's start to its goal; its motions need
/// not be allowed. Via points are ignored.
Polyline tubeRoute(const Problem& problem, const Polyline& guide, const TubeOptions& options = {},
                   const StopCheck& stop = {});

}  // namespace talus::planner
