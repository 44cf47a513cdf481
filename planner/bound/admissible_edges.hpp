#pragma once

#include <memory>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Edge costs between neighbouring cell corners, along cell sides and across cells. The cost-to-go field over
/// these edges is a lower bound of the cost of every continuous route, of any shape and heading, not of grid
/// routes only. Corners are numbered like cells: a corner has the index of the cell to its north-east; the
/// corner grid has one column and one row more than the cell grid.
///
/// Why the field is a lower bound (ours, not from the literature). In each cell let w_k be the
/// DirectionalLowerBounds for the eight headings, lowered until sqrt(2) w_k <= w_(k-1) + w_(k+1). The norm N
/// that equals w_k at the eight headings and is linear between them is then convex and nowhere above the
/// drive cost of the cell. Take a field over corners whose differences along the sides and both diagonals of
/// the cell are at most w_k, and interpolate the field linearly along the sides. The field then changes
/// between any two points of the cell's boundary by at most N, so a continuation into the cell exists that
/// changes no faster than N (McShane 1934 [mcshane_1934]). Along any allowed motion the continued field
/// changes by at most the motion's cost. A step along a side has the lower cost of the two cells beside the
/// side. Costs are rounded down to whole units.
///
/// Returns null when stopped, or if the lower bound of some step is 0.
std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const StopCheck& stop = {});

}  // namespace talus::planner
