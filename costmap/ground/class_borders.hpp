#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Returns, by cell index, whether a cell of another class lies within `reach` columns and rows of the cell;
/// empty for an empty raster.
std::vector<bool> classBorders(const maps::Raster<std::uint8_t>& classes, int reach);

}  // namespace talus::costmap
