#pragma once

#include <vector>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Path from cell to cell, straight within each cell, with turns only on edges between cells. Coordinates are
/// in cells from the south-west corner of the map.
struct EdgePath {
  /// Point on a cell edge at which the path may turn.
  struct Turn {
    double x = 0.0;
    double y = 0.0;
    /// True: the point is on an edge between two columns, and y may vary. False: the point is on an edge
    /// between two rows, and x may vary.
    bool on_vertical = false;
  };
  std::vector<Turn> turns;        ///< turns in order; the first and the last are the fixed ends of the path
  std::vector<maps::Cell> cells;  ///< cells[i] contains the motion from turns[i] to turns[i + 1]

  bool empty() const noexcept { return turns.empty(); }
  /// Returns the turns in map coordinates [m].
  std::vector<maps::Point> points(const maps::Grid& grid) const;
};

/// Moves the turns along their edges to reduce the cost. Each of the `rounds` rounds is a dynamic programme
/// over a few positions around each turn; the spacing of the positions decreases from `coarsest_cells`
/// [cells]. The cost never increases.
void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds);

}  // namespace talus::planner
