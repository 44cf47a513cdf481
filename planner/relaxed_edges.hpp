#pragma once

#include <memory>

#include <planner/edge_layer.hpp>

namespace talus::planner {

/// Steps of the 8-neighbourhood so cheap that the field over them is below the cost of every continuous
/// route, of any shape and any headings, not of grid routes only.
///
/// Why it is a bound (ours). In each square between four cell centres let w_k be, for the eight headings, the
/// least over the four cells of their HeadingMinorants, lowered until sqrt(2) w_k <= w_(k-1) + w_(k+1). The norm
/// N that has w_k at the eight headings and is linear between them is then convex, and nowhere above the drive
/// cost of the four cells, since it is nowhere above the gauge of any of them. (In the outer half of border
/// cells: cos(pi/8) times the least level under the curve; between two headings the octagon exceeds the circle
/// by 1 / cos(pi/8) at most.) A field over centres whose differences along the sides and both diagonals of the square stay within
/// w_k, taken as linear along its sides, changes between any two points of its boundary by no more than N; so
/// it can be continued into the square without changing faster than N (McShane 1934 [mcshane_1934]).
/// Continued so everywhere, it changes along any allowed motion by no more than the motion's cost. A step
/// along a side takes the lesser price of the two squares beside it. Whole units are rounded down.
///
/// Null when stopped, or where some ground costs nothing.
std::shared_ptr<const EdgeLayer> relaxedEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                              const StopCheck& stop = {});

}  // namespace talus::planner
