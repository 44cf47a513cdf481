#pragma once

#include <vector>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Path from cell to cell: straight within each cell, with turns only on edges between cells. Coordinates are
/// in cells from the map's south-west corner.
struct EdgePath {
  struct Turn {
    double x = 0.0;
    double y = 0.0;
    /// True on the edge between two columns (y may vary); false on the edge between two rows (x may vary).
    bool on_vertical = false;
  };
  std::vector<Turn> turns;        ///< the first and last turn are the fixed ends
  std::vector<maps::Cell> cells;  ///< cells[i] contains the motion from turns[i] to turns[i + 1]

  bool empty() const noexcept { return turns.empty(); }
  std::vector<maps::Point> points(const maps::Grid& grid) const;
};

/// Moves the turns along their edges to reduce the cost: dynamic programming over a few positions around each
/// turn, with spacings decreasing from `coarsest_cells`, for `rounds` rounds. Never increases the cost.
void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds);

}  // namespace talus::planner
