#pragma once

#include <vector>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// A way from cell to cell: straight within each, turning only where it crosses from one into the next.
/// Coordinates are in cells from the map's south-west corner.
struct EdgePath {
  struct Turn {
    double x = 0.0;
    double y = 0.0;
    /// On the edge between two columns, free to move along y; else between two rows.
    bool on_vertical = false;
  };
  std::vector<Turn> turns;        ///< first and last are the ends and stay
  std::vector<maps::Cell> cells;  ///< cells[i] holds the motion from turns[i] to turns[i + 1]

  bool empty() const noexcept { return turns.empty(); }
  std::vector<maps::Point> points(const maps::Grid& grid) const;
};

/// Moves the turns along the edges that they lie on so that the way gets cheaper: dynamic programming over a
/// few places around each, ever closer, from `coarsest_cells` on for `rounds` rounds. Never more expensive.
void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds);

}  // namespace talus::planner
