#pragma once

#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Returns the cells that intersect a closed disc around a place; cells are closed. A place on a side has two
/// cells, on a corner four.
std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m);

}  // namespace talus::planner
