#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include <talus/planner/field/grid_route.hpp>

namespace talus::planner {

Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places, const StopCheck& stop) {
  const auto links = linksFrom(cost, places.from);
  const GridLink* best = nullptr;
  double best_J = kInfinity;
  for (const GridLink& link : links) {
    if (!field.settle(link.cell, stop)) return {};
    const auto rest_J = field.cost_J(link.cell);
    if (!rest_J || link.cost_J + *rest_J >= best_J) continue;
    best_J = link.cost_J + *rest_J;
    best = &link;
  }
  if (!best) return {};
  Polyline points{places.from};
  for (const maps::Cell cell : field.path(best->cell)) append(points, {cost.map().grid().centre(cell)});
  if (std::isfinite(cost({points.back(), places.to}))) append(points, {places.to});
  return points;
}

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

// The cell nearest to a place among the cells with wanted(cell).
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

// Description of the hazard in a cell; empty if the cell has no hazard of its own.
const char* inWords(costmap::Hazard found, bool stated) noexcept {
  using costmap::Hazard;
  if (has(found, Hazard::KeepOut)) return "a keep-out area, or where a layer refuses";
  if (has(found, Hazard::Obstacle))
    return stated ? "an infinite cost" : "a terrain class declared impassable";
  if (has(found, Hazard::Rocks)) return "rocks";
  if (has(found, Hazard::Step)) return "a step higher than the wheels climb";
  if (has(found, Hazard::Slope)) return "ground steeper than the rover may stand";
  if (has(found, Hazard::Roughness)) return "ground too rough for the rover's belly";
  return has(found, Hazard::Unknown) ? "unobserved ground" : "";
}

// Reason for the clearance in a cell: the nearest cell with a hazard, or the map border if nearer.
std::string clearOf(const costmap::CostGrid& map, Cell cell, const HazardsOf& hazards) {
  const maps::Grid& grid = map.grid();
  const bool stated = map.cost().limits().stated;
  const int to_rim =
      std::min({cell.column, cell.row, grid.width - 1 - cell.column, grid.height - 1 - cell.row}) + 1;
  const auto near = nearest(grid, grid.centre(cell), [&](Cell c) {
    return std::max(std::abs(c.column - cell.column), std::abs(c.row - cell.row)) <= to_rim &&
           *inWords(hazards(c), stated) != '\0';
  });
  return near ? inWords(hazards(*near), stated) : "the rim of the map";
}

std::string whyInvalid(const costmap::CostGrid& map, Point place, const HazardsOf& hazards) {
  const auto cell = map.grid().cellAt(place);
  if (!cell) return "lies outside the map";
  const auto curve = map.at(*cell).curve();
  if (curve == costmap::CellCode::kUnknown) return "lies on an unobserved cell";
  if (curve != costmap::CellCode::kBlocked) return "lies on a dangerous cell: no heading is allowed there";
  if (!hazards) return "lies on a blocked cell";
  const std::string found = inWords(hazards(*cell), map.cost().limits().stated);
  return found.empty() ? "lies on a blocked cell, too near to " + clearOf(map, *cell, hazards)
                       : "lies on a blocked cell: " + found;
}

}  // namespace

std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, Point place,
                         const PlaceDiagnostics& help) {
  const std::string line = which + " " + text(place) + " " + whyInvalid(map, place, help.hazards);
  const MotionCost cost(std::make_shared<costmap::CostGrid>(map));
  const auto allowed = [&](Cell c) { return cost.allowed(map.grid().centre(c)); };
  if (help.joined) {
    const auto joined = nearest(map.grid(), place, [&](Cell c) { return help.joined(c) && allowed(c); });
    if (joined)
      return line + "; the nearest traversable cell is " + text(map.grid().centre(*joined)) +
             (which == "start" ? ", from which the goal can be reached"
                               : ", which can be reached from the start");
  }
  const auto cell = nearest(map.grid(), place, allowed);
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
