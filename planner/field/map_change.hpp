#pragma once

#include <optional>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Returns the smallest box around all cells that differ between two versions of a map on the same grid;
/// empty if no cell differs. Tiles that both versions share are skipped.
std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer);

}  // namespace talus::planner
