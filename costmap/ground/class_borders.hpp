#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Returns for each cell, by its index in the grid, whether a cell of another terrain class lies within
/// `reach` columns and rows of it. Returns an empty vector for an empty raster.
std::vector<bool> classBorders(const maps::Raster<std::uint8_t>& classes, int reach);

}  // namespace talus::costmap
