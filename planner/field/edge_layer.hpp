#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Indexing of cells in an array with a border of one cell on every side, so that every cell of the grid has
/// eight neighbours. The index is here called the padded index.
struct PaddedGrid {
  int width = 0;   ///< number of columns without the border
  int height = 0;  ///< number of rows without the border

  std::size_t stride() const noexcept { return static_cast<std::size_t>(width) + 2; }
  std::size_t size() const noexcept { return stride() * (static_cast<std::size_t>(height) + 2); }
  /// Returns the padded index of a cell.
  std::size_t index(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row + 1) * stride() + static_cast<std::size_t>(c.column + 1);
  }
  /// Returns the cell with a padded index.
  maps::Cell cell(std::size_t index) const noexcept {
    return {static_cast<int>(index % stride()) - 1, static_cast<int>(index / stride()) - 1};
  }
  /// Returns the padded index of the neighbour in `heading` minus the padded index of a cell.
  std::ptrdiff_t offset(int heading) const noexcept {
    const maps::Cell step = kStep[static_cast<std::size_t>(heading)];
    return static_cast<std::ptrdiff_t>(step.row) * static_cast<std::ptrdiff_t>(stride()) + step.column;
  }
};

using maps::CellBox;

/// Returns the box extended by `cells` cells on every side and clipped to the grid.
inline CellBox grown(CellBox box, int cells, const PaddedGrid& grid) noexcept {
  return {
      {std::max(box.first.column - cells, 0), std::max(box.first.row - cells, 0)},
      {std::min(box.last.column + cells, grid.width - 1), std::min(box.last.row + cells, grid.height - 1)}};
}

/// Costs of all steps from a cell centre to its eight neighbours, on one version of the map, in units of
/// EdgeUnits; 16 bytes per cell. A step consists of two half steps, one in the cell that it leaves and one in
/// the cell that it enters, both on the heading of the step. Its cost is that of MotionCost for the segment
/// between the centres. A diagonal step is blocked unless the two other cells at its corner also allow the
/// heading.
class EdgeLayer {
 public:
  static constexpr std::uint16_t kBlocked = EdgeUnits::kBlocked;

  /// Computes the layer with `threads` threads; the result does not depend on their number. The computation
  /// ends early when a stop is requested; complete() is then false.
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads = 1,
            const StopCheck& stop = {}, Kernels kernels = Kernels::Best);

  /// Size of a grid of points other than the cells of the map, for a layer without step costs.
  struct Unfilled {
    int width;
    int height;
  };
  /// Creates a layer without step costs, which the caller writes through into().
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, Unfilled points);

  std::uint16_t* into(std::size_t index) noexcept { return edges_.get() + 8 * index; }

  /// Returns the costs of the eight steps into the cell with a padded index. The index of a step is the
  /// heading, seen from the cell, of the neighbour at which the step begins.
  const std::uint16_t* into(std::size_t index) const noexcept { return edges_.get() + 8 * index; }

  const PaddedGrid& padded() const noexcept { return padded_; }
  const EdgeUnits& units() const noexcept { return units_; }
  const costmap::CostGrid& map() const noexcept { return *map_; }
  const std::shared_ptr<const costmap::CostGrid>& mapPointer() const noexcept { return map_; }
  /// Returns false if a stop ended the computation.
  bool complete() const noexcept { return complete_; }

  /// Updates the layer to the newer version `newer` of the same grid. The units must extend the present units
  /// (EdgeUnits::extends()), and cells outside the box `changed` must be equal in both versions.
  void update(std::shared_ptr<const costmap::CostGrid> newer, const EdgeUnits& units, CellBox changed);

 private:
  void buildRows(CellBox box);
  void blockBorder();

  std::shared_ptr<const costmap::CostGrid> map_;
  EdgeUnits units_;
  PaddedGrid padded_;
  LargeArray<std::uint16_t> edges_;
  bool vectors_ = false;
  bool complete_ = false;
};

/// Returns the cells of the cheapest path from the cell `from` to a goal, including both, by following a
/// cost-to-go field; empty if there is no path. Of equally cheap paths, the first in the order of headings is
/// returned. distance(index) returns the exact cost to the goal in units for a padded index; atGoal(index)
/// returns the remaining cost if the cell is a goal. Both return the largest uint32 if there is no such
/// value.
template <typename Distance, typename AtGoal>
std::vector<maps::Cell> descent(const EdgeLayer& edges, maps::Cell from, Distance distance, AtGoal atGoal) {
  constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();
  const PaddedGrid& padded = edges.padded();
  std::vector<maps::Cell> path;
  std::size_t at = padded.index(from);
  std::uint32_t left = distance(at);
  if (left == kUnreached) return path;
  path.push_back(from);
  while (atGoal(at) != left) {
    const std::size_t before = at;
    for (int heading = 0; heading < 8 && at == before; ++heading) {
      const std::size_t next = before + static_cast<std::size_t>(padded.offset(heading));
      const std::uint16_t edge = edges.into(next)[opposite(heading)];
      if (edge == EdgeLayer::kBlocked || edge > left || distance(next) != left - edge) continue;
      at = next;
      left -= edge;
    }
    if (at == before) return {};  // not settled
    path.push_back(padded.cell(at));
  }
  return path;
}

/// Returns the smallest box around all cells that differ between two versions of a map on the same grid;
/// empty if no cell differs. Tiles that both versions share are skipped.
std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer);

}  // namespace talus::planner
