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

/// A way along the grid from start to goal near a guide: the field of one box of tiles around each leg of the
/// guide, ground beside the tube left out. A leg whose way touches the wall of the tube is searched again in
/// a wider one; a leg without a way is joined with the next. Holds no more than a few legs' boxes at a time.
/// Empty when no way was found, which proves nothing, or when stopped. The guide runs from the problem's
/// start to its goal; its motions need not be allowed. Via points are not looked at.
Polyline tubeRoute(const Problem& problem, const Polyline& guide, const TubeOptions& options = {},
                   const StopCheck& stop = {});

}  // namespace talus::planner
