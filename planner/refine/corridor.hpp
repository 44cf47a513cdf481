#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Corridor around a path: the cells within a distance of the path, copied from the map into a box with a
/// margin of two cells (a path that ends on an edge touches the next cell). The other cells of the box are
/// unknown and not drivable. Cells have local indices, row by row in the box.
class Corridor {
 public:
  /// Holder number of a cell that is not a holder.
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Copies the cells within `reach_cells` of the path `along`, which must lie inside the map.
  Corridor(const costmap::CostGrid& map, const EdgeCrossings& crossings,
           const std::vector<maps::Point>& along, int reach_cells);

  /// Returns the local index of a cell.
  std::size_t local(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row - first_.row) * columns_ +
           static_cast<std::size_t>(c.column - first_.column);
  }
  /// Returns the cell with a local index.
  maps::Cell cell(std::size_t local) const noexcept {
    return {first_.column + static_cast<int>(local % columns_),
            first_.row + static_cast<int>(local / columns_)};
  }

  /// Returns the local index of the cell adjacent to `cell` across a side (CellSide).
  std::size_t beyond(std::size_t cell, int side) const noexcept {
    return side == kWestSide    ? cell - 1
           : side == kEastSide  ? cell + 1
           : side == kSouthSide ? cell - columns_
                                : cell + columns_;
  }

  costmap::CellCode code(std::size_t cell) const noexcept { return codes_[cell]; }

  /// Returns true if every heading is allowed in the cell.
  bool free(std::size_t cell) const noexcept { return free_[cell] != 0; }

  /// Returns the holder number of a cell. Data of edges are stored with holder cells: the west and south
  /// edges of a cell belong to this cell. The holders are the cells of the corridor and their neighbours to
  /// the east and north; they are numbered from 0.
  std::uint32_t holder(std::size_t cell) const noexcept { return holder_[cell]; }
  /// Returns the local index of the cell with a holder number.
  std::size_t held(std::uint32_t holder) const noexcept { return held_[holder]; }
  std::size_t holders() const noexcept { return held_.size(); }

  /// Assigns holder numbers to a cell and its eastern and northern neighbours. The cell must be at least one
  /// row inside the box.
  void hold(std::size_t cell);

 private:
  void open(const costmap::CostGrid& map, const EdgeCrossings& crossings, maps::Cell around, int reach_cells);

  maps::Cell first_;
  std::size_t columns_ = 0;
  std::vector<costmap::CellCode> codes_;
  std::vector<std::uint8_t> free_, open_;
  std::vector<std::uint32_t> holder_, held_;
};

}  // namespace talus::planner
