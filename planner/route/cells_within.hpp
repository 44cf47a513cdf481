#pragma once

#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Returns the cells of `grid` that intersect the closed disc with the centre `place` and the radius
/// `radius_m`. Cells are closed sets: for radius 0, a place on a cell side has two cells, a place at a corner
/// four.
std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m);

}  // namespace talus::planner
