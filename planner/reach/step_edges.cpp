#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <talus/planner/reach/step_edges.hpp>

namespace talus::planner {
namespace {

using costmap::Hazard;
using maps::Cell;

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameStep_m = 1e-3;  // heights are floats: smaller differences of steps are rounding
constexpr int kAround = 2;            // cells on each side whose rises determine a gradient

Cell operator+(Cell a, Cell b) noexcept {
  return {a.column + b.column, a.row + b.row};
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

StepEdges::StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses)
    : map_(map), kinds_(map.grid().size(), Kind::None) {
  if (!hazards || map.content().elevation_m.size() == 0) return;
  const double allowed_m = highestAllowed_m(hazards) + kSameStep_m;
  std::vector<Cell> sheer, of_slopes;
  forEachPair([&](const Pair& pair) {
    const double step_m = pair.step_m();
    if (!(step_m > allowed_m)) return;
    const double steepest_m = std::max({std::abs(pair.before), std::abs(pair.between), std::abs(pair.after)});
    const bool is_sheer = pair.excess_m() > std::max(allowed_m, 0.5 * step_m);
    if (!is_sheer && !refuses(pair.first, steepest_m / map.grid().resolution_m)) return;
    std::vector<Cell>& ends = is_sheer ? sheer : of_slopes;
    ends.push_back(pair.first);
    ends.push_back(pair.second);
  });
  spread(hazards, sheer, of_slopes);
}

double StepEdges::highestAllowed_m(const HazardsOf& hazards) const {
  double allowed_m = 0.0;
  forEachPair([&](const Pair& pair) {
    const double step_m = pair.step_m();
    if (!(step_m > allowed_m)) return;
    const Hazard first = hazards(pair.first), second = hazards(pair.second);
    if (has(first | second, Hazard::Unknown)) return;
    if (!has(first, Hazard::Step) || !has(second, Hazard::Step)) allowed_m = step_m;
  });
  return allowed_m;
}

double StepEdges::Pair::step_m() const noexcept {
  const double shared =
      before * after > 0.0 ? std::copysign(std::min(std::abs(before), std::abs(after)), before) : 0.0;
  return std::abs(between - shared);
}

double StepEdges::Pair::excess_m() const noexcept {
  const double way = std::copysign(1.0, between);
  return std::abs(between) - std::max({way * before, way * after, 0.0});
}

double StepEdges::height_m(Cell cell) const noexcept {
  if (!map_.grid().contains(cell)) return kNoHeight;
  const auto tile = static_cast<std::size_t>((cell.row >> 6) * map_.tileColumns() + (cell.column >> 6));
  return static_cast<double>(map_.content().elevation_m.tile(tile).cells[static_cast<std::size_t>(
      (cell.row & 63) << 6 | (cell.column & 63))]);
}

// A missing height on one side is replaced by the rise on the other side.
std::optional<StepEdges::Pair> StepEdges::pair(Cell cell, Cell step) const noexcept {
  const Cell next = cell + step, back{-step.column, -step.row};
  const double here_m = height_m(cell), there_m = height_m(next);
  if (std::isnan(here_m) || std::isnan(there_m)) return std::nullopt;
  double before = here_m - height_m(cell + back), after = height_m(next + step) - there_m;
  if (std::isnan(before)) before = std::isnan(after) ? 0.0 : after;
  if (std::isnan(after)) after = before;
  return Pair{cell, next, before, there_m - here_m, after};
}

template <typename Take>
void StepEdges::forEachPair(Take take) const {
  for (int row = 0; row < map_.grid().height; ++row)
    for (int column = 0; column < map_.grid().width; ++column)
      for (const Cell step : {Cell{1, 0}, Cell{0, 1}})
        if (const auto found = pair({column, row}, step)) take(*found);
}

void StepEdges::spread(const HazardsOf& hazards, const std::vector<Cell>& sheer,
                       const std::vector<Cell>& of_slopes) {
  const maps::Grid& grid = map_.grid();
  std::deque<Cell> open;
  const auto take = [&](Cell cell, Kind kind) {
    Kind& own = kinds_[grid.index(cell)];
    if (own != Kind::None || !has(hazards(cell), Hazard::Step | Hazard::Roughness)) return;
    own = kind;
    open.push_back(cell);
  };
  for (const Cell cell : sheer) take(cell, Kind::Sheer);
  for (const Cell cell : of_slopes) take(cell, Kind::Slope);
  for (; !open.empty(); open.pop_front()) {
    const Cell cell = open.front();
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row})) take({column, row}, kinds_[grid.index(cell)]);
  }
}

costmap::CellCode StepEdges::settled(Cell cell) const {
  std::vector<double> east, north;
  for (int row = -kAround; row <= kAround; ++row)
    for (int column = -kAround; column <= kAround; ++column) {
      const Cell from = cell + Cell{column, row};
      const double here_m = height_m(from);
      const double east_m = column < kAround ? height_m(from + Cell{1, 0}) - here_m : kNoHeight;
      const double north_m = row < kAround ? height_m(from + Cell{0, 1}) - here_m : kNoHeight;
      if (!std::isnan(east_m)) east.push_back(east_m);
      if (!std::isnan(north_m)) north.push_back(north_m);
    }
  if (east.empty() || north.empty()) return map_.at(cell);
  return costmap::CellCode({.dz_dx = median(east) / map_.grid().resolution_m,
                            .dz_dy = median(north) / map_.grid().resolution_m,
                            .curve = map_.at(cell).curve()});
}

}  // namespace talus::planner
