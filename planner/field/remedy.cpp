#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include <talus/planner/field/remedy.hpp>
#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

std::string text(Point p) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, "%.2f,%.2f", p.x_m, p.y_m);
  return buffer;
}

double squared_m2(Point a, Point b) noexcept {
  return (a.x_m - b.x_m) * (a.x_m - b.x_m) + (a.y_m - b.y_m) * (a.y_m - b.y_m);
}

// The cell nearest to a place among those for which wanted(cell) holds.
template <typename Wanted>
std::optional<Cell> nearest(const maps::Grid& grid, Point place, Wanted wanted) {
  std::optional<Cell> best;
  double best_m2 = std::numeric_limits<double>::infinity();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const double away_m2 = squared_m2(grid.centre({column, row}), place);
      if (away_m2 >= best_m2 || !wanted(Cell{column, row})) continue;
      best_m2 = away_m2;
      best = Cell{column, row};
    }
  return best;
}

std::string whyInvalid(const costmap::CostGrid& map, Point place) {
  const auto cell = map.grid().cellAt(place);
  if (!cell) return "lies outside the map";
  const auto curve = map.at(*cell).curve();
  if (curve == costmap::CellCode::kUnknown) return "lies on an unobserved cell";
  if (curve == costmap::CellCode::kBlocked) return "lies on a blocked cell";
  return "lies on a dangerous cell: no heading is allowed there";
}

}  // namespace

std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, Point place) {
  std::string line = which + " " + text(place) + " " + whyInvalid(map, place);
  const MotionCost cost(std::make_shared<costmap::CostGrid>(map));
  const auto cell = nearest(map.grid(), place, [&](Cell c) { return cost.allowed(map.grid().centre(c)); });
  if (!cell) return line + "; no cell of this map is traversable";
  return line + "; the nearest traversable cell is " + text(map.grid().centre(*cell));
}

bool mayEnd(const MotionCost& cost, Point place, double tolerance_m) {
  if (cost.allowed(place)) return true;
  if (!(tolerance_m > 0.0)) return false;
  const maps::Grid& grid = cost.map().grid();
  for (const Cell cell : cellsWithin(grid, place, tolerance_m))
    if (cost.allowed(grid.centre(cell))) return true;
  return false;
}

}  // namespace talus::planner
