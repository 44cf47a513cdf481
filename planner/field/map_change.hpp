#pragma once

#include <optional>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// The smallest box around all cells that differ between two versions of a map on the same grid; nothing when
/// none does. Tiles that both versions share are not looked at.
std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer);

}  // namespace talus::planner
