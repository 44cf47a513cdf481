#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <talus/planner/field/grid_links.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/other_corridors.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using maps::Cell;
using maps::Point;

constexpr int kSquare = 8;   // cells per side: twice the reach of the refinement to either side
constexpr int kTries = 500;  // largest number of squares examined
constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

// The terrain with all gradients reversed.
std::shared_ptr<const costmap::CostGrid> turned(const costmap::CostGrid& map) {
  const costmap::Revision upside_down{
      .ranges = {{{0, 0}, {map.grid().width - 1, map.grid().height - 1}}},
      .code =
          [](Cell, CellCode old) {
            return CellCode({.dz_dx = -old.dzDx(), .dz_dy = -old.dzDy(), .curve = old.curve()});
          },
      .cost = [&map] { return map.content().cost; }};
  return std::make_shared<const costmap::CostGrid>(costmap::revised(map, upside_down));
}

// Number of consecutive cells, on the cheapest grid route through a cell, that no cheaper route passes. A
// detour from a cheaper route and back has only one such cell.
std::size_t ownCells(const CostToGo& from_start, const CostToGo& to_goal, Cell through) {
  const auto sum = [&](Cell cell) { return std::uint64_t{from_start.units(cell)} + to_goal.units(cell); };
  const std::uint64_t least = sum(through);
  std::size_t count = 1;
  for (const CostToGo* field : {&from_start, &to_goal})
    for (const Cell cell : field->path(through)) {
      if (sum(cell) < least) break;
      ++count;
    }
  return count;
}

// Map divided into squares, with the cheapest grid route through each square and whether a known route passes
// near.
class Squares {
 public:
  Squares(const maps::Grid& grid, const CostToGo& from_start, const CostToGo& to_goal)
      : grid_(grid),
        columns_((grid.width + kSquare - 1) / kSquare),
        rows_((grid.height + kSquare - 1) / kSquare),
        squares_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const std::uint64_t begun = from_start.units({column, row}), rest = to_goal.units({column, row});
        if (begun == CostToGo::kUnreached || rest == CostToGo::kUnreached) continue;
        Square& square = at(column / kSquare, row / kSquare);
        if (begun + rest < square.least) square = {begun + rest, {column, row}, false};
      }
  }

  // Marks the squares that a route passes and their neighbours.
  void pass(const Polyline& route) {
    for (const Point& p : subdivided(route, 0.5 * kSquare * grid_.resolution_m)) {
      const auto cell = grid_.cellAt(p);
      if (!cell) continue;
      around(cell->column / kSquare, cell->row / kSquare, [](Square& square) { square.passed = true; });
    }
  }

  std::uint64_t least() const {
    std::uint64_t least = kNone;
    for (const Square& square : squares_) least = std::min(least, square.least);
    return least;
  }

  // The cheapest cell of each square with a cost of at most `most`, cheapest first.
  std::vector<Cell> upTo(double most) const {
    std::vector<Square> chosen;
    for (const Square& square : squares_)
      if (square.least != kNone && static_cast<double>(square.least) <= most) chosen.push_back(square);
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const Square& a, const Square& b) { return a.least < b.least; });
    std::vector<Cell> cells;
    for (const Square& square : chosen) cells.push_back(square.cell);
    return cells;
  }

  bool passed(Cell cell) { return at(cell.column / kSquare, cell.row / kSquare).passed; }

 private:
  struct Square {
    std::uint64_t least = kNone;
    Cell cell{};
    bool passed = false;
  };

  Square& at(int column, int row) {
    return squares_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }
  template <typename Each>
  void around(int column, int row, Each each) {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r)
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) each(at(c, r));
  }

  maps::Grid grid_;
  int columns_, rows_;
  std::vector<Square> squares_;
};

}  // namespace

std::vector<Polyline> otherCorridors(const MotionCost& cost,
                                     const std::shared_ptr<const costmap::CostGrid>& map, CostToGo& to_goal,
                                     const Segment& places, const Polyline& known,
                                     const CorridorChoice& choice, const StopCheck& stop) {
  const auto upside_down = turned(*map);
  const MotionCost back(upside_down);
  const auto edges = std::make_shared<EdgeLayer>(upside_down, to_goal.edges().units(), 1, stop);
  const auto begins = fieldGoals(back, places.from, 0.0);
  if (!edges->complete() || begins.empty()) return {};
  CostToGo from_start(edges, begins);
  if (!from_start.settleAll(stop) || !to_goal.settleAll(stop)) return {};
  Squares squares(map->grid(), from_start, to_goal);
  squares.pass(known);
  const double most = (1.0 + choice.within) * static_cast<double>(squares.least());
  std::vector<Polyline> found;
  int tries = 0;
  for (const Cell through : squares.upTo(most)) {
    if (found.size() == choice.most || tries == kTries || stop()) break;
    if (squares.passed(through) || (++tries, ownCells(from_start, to_goal, through) < kSquare)) continue;
    const Point middle = map->grid().centre(through);
    Polyline route = gridRoute(back, from_start, {middle, places.from}, stop);
    std::reverse(route.begin(), route.end());
    const Polyline rest = gridRoute(cost, to_goal, {middle, places.to}, stop);
    append(route, rest);
    if (rest.empty() || !(route.front() == places.from) || !std::isfinite(cost.along(route))) continue;
    squares.pass(route);
    found.push_back(std::move(route));
  }
  return found;
}

}  // namespace talus::planner
