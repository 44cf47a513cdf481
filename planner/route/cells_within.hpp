#pragma once

#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// The cells that a disc about a place touches, closed cells both: of a place on a side two, on a corner four.
std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m);

}  // namespace talus::planner
