#pragma once

#include <memory>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Returns lower bounds of the costs between neighbouring cell corners, along cell sides and across cells.
/// The cost-to-go field over these edges is a lower bound of the cost of every continuous route of any shape
/// and heading, not only of grid routes. Corners are numbered like cells: a corner has the index of the cell
/// to its north-east. The corner grid has one column and one row more than the cell grid.
///
/// Proof of the lower bound (ours, not from the literature). In each cell let w_k be the
/// DirectionalLowerBounds for the eight headings, reduced until sqrt(2) w_k <= w_(k-1) + w_(k+1). The norm N
/// that equals w_k at the eight headings and is linear between them is then convex and at most equal to the
/// cost per metre of the cell. Take a field over corners whose differences along the sides and both diagonals
/// of the cell are at most w_k, and interpolate the field linearly along the sides. Between any two points of
/// the cell's boundary the field then changes by at most N. Therefore the field can be extended into the cell
/// such that it changes no faster than N (McShane 1934 [mcshane_1934]). Along any allowed motion the extended
/// field changes by at most the cost of the motion. A step along a side has the lower of the costs in the two
/// cells beside the side. Costs are rounded down to whole units.
///
/// Returns null after a stop, or if the lower bound of some step is 0.
std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const StopCheck& stop = {});

}  // namespace talus::planner
