#pragma once

#include <memory>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Steps between neighbouring corners of cells, along edges and across cells, so cheap that the field over
/// them is below the cost of every continuous route, of any shape and any headings, not of grid routes only.
/// Corners are numbered as cells are, the one in the south-west of a cell like it, one more column and row of
/// them.
///
/// Why it is a bound (ours). In each cell let w_k be its DirectionalLowerBounds, for the eight headings, lowered
/// until sqrt(2) w_k <= w_(k-1) + w_(k+1). The norm N that has w_k at the eight headings and is linear
/// between them is then convex, and nowhere above the drive cost of the cell. A field over corners whose
/// differences along the sides and both diagonals of the cell stay within w_k, taken as linear along its
/// sides, changes between any two points of its boundary by no more than N; so it can be continued into the
/// cell without changing faster than N (McShane 1934 [mcshane_1934]). Continued so everywhere, it changes
/// along any allowed motion by no more than the motion's cost. A step along a side takes the lesser price of
/// the two cells beside it. Whole units are rounded down.
///
/// Null when stopped, or where some ground costs nothing.
std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const StopCheck& stop = {});

}  // namespace talus::planner
