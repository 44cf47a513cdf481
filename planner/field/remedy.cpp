#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include <talus/planner/field/grid_links.hpp>
#include <talus/planner/field/remedy.hpp>

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

// Cells the rover can get to from the links of the start.
std::vector<bool> reachable(const EdgeLayer& edges, const std::vector<GridLink>& links) {
  const PaddedGrid& padded = edges.padded();
  std::vector<bool> seen(padded.size(), false);
  std::vector<std::size_t> open;
  const auto visit = [&](std::size_t index) {
    if (seen[index]) return;
    seen[index] = true;
    open.push_back(index);
  };
  for (const GridLink& link : links) visit(padded.index(link.cell));
  while (!open.empty()) {
    const std::size_t from = open.back();
    open.pop_back();
    for (int heading = 0; heading < 8; ++heading) {
      const std::size_t to = from + static_cast<std::size_t>(padded.offset(heading));
      if (edges.into(to)[opposite(heading)] != EdgeLayer::kBlocked) visit(to);
    }
  }
  return seen;
}

}  // namespace

std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, Point place) {
  std::string line = which + " " + text(place) + " " + whyInvalid(map, place);
  const MotionCost cost(std::make_shared<costmap::CostGrid>(map));
  const auto cell = nearest(map.grid(), place, [&](Cell c) { return cost.allowed(map.grid().centre(c)); });
  if (!cell) return line + "; no cell of this map is traversable";
  return line + "; the nearest traversable cell is " + text(map.grid().centre(*cell));
}

std::string noWay(const EdgeLayer& edges, Point start, Point goal) {
  const auto links = linksFrom(MotionCost(edges.mapPointer()), start);
  const std::vector<bool> seen = reachable(edges, links);
  std::size_t count = 0;
  for (const bool one : seen) count += one ? 1U : 0U;
  const maps::Grid& grid = edges.map().grid();
  const auto cell = nearest(grid, goal, [&](Cell c) { return seen[edges.padded().index(c)]; });
  std::string line = "no route from " + text(start) + " to " + text(goal) +
                     ": reachable from the start: " + std::to_string(count) + " cells";
  if (!cell) return line + "; choose another start";
  char away[48];
  std::snprintf(away, sizeof away, " (%.1f m from the goal)",
                std::sqrt(squared_m2(grid.centre(*cell), goal)));
  return line + "; the nearest of them to the goal is " + text(grid.centre(*cell)) + away;
}

}  // namespace talus::planner
