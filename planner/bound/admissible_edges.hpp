#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <talus/planner/bound/fitted_octagon.hpp>
#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner {

/// Returns the octagon of a cell inside the map; infinite weights for a cell that no route enters.
using OctagonOf = std::function<Octagon(maps::Cell)>;

/// Direction of the routes: from the corners of cells to the goal, or from the start to the corners.
enum class RouteSense { ToGoal, FromStart };

/// Returns lower bounds of the costs between neighbouring cell corners, along cell sides and across cells.
/// The cost-to-go field over these edges is a lower bound of the cost of every continuous route of any shape
/// and heading, not only of grid routes. Corners are numbered like cells: a corner has the index of the cell
/// to its north-east. The corner grid has one column and one row more than the cell grid. For
/// RouteSense::FromStart every edge has the cost of the opposite motion.
///
/// Proof of the lower bound (ours, not from the literature). The gauge N of an Octagon is convex and at most
/// equal to the cost per metre of the cell. Take a field over corners whose differences along the sides and
/// both diagonals of the cell are at most w_k, and interpolate the field linearly along the sides. Between any
/// two points of the cell's boundary the field then changes by at most N. Therefore the field can be extended
/// into the cell such that it changes no faster than N (McShane 1934 [mcshane_1934]). Along any allowed motion
/// the extended field changes by at most the cost of the motion. A step along a side has the lower of the
/// costs in the two cells beside the side. Costs are rounded down to whole units.
///
/// Returns null after a stop, or if the lowest cost per metre of the map is 0.
std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const OctagonOf& octagon_of, const StopCheck& stop = {},
                                                 RouteSense sense = RouteSense::ToGoal);

/// Returns the cost-to-go field [J] over admissibleEdges() by index of the corner, row by row: at most the
/// given value at `ends`, infinite where no route leads. The result is empty after a stop, or if the
/// lowest cost per metre of the map is 0.
std::vector<float> cornerField(const std::shared_ptr<const costmap::CostGrid>& map,
                               const OctagonOf& octagon_of, std::vector<FieldGoal> ends,
                               const StopCheck& stop = {}, RouteSense sense = RouteSense::ToGoal);

}  // namespace talus::planner
