#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_set>
#include <utility>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/cheapest_metre.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution_check.hpp>
#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {
namespace {

constexpr auto kFar = static_cast<float>(kInfinity);
constexpr double kLeastGain = 5e-3;  // smallest relative gain of a round for which another one follows
// Work: nodes that each search of the mesh may take, and cells fitted in the rounds of level 2; a constant and
// a share of the cells of the map.
constexpr std::size_t kNodes = 500'000;
constexpr double kNodesPerCell = 0.2;

// Index of a corner in a cornerField().
std::size_t cornerIndex(const maps::Grid& grid, maps::Cell corner) noexcept {
  return static_cast<std::size_t>(corner.row) * (static_cast<std::size_t>(grid.width) + 1) +
         static_cast<std::size_t>(corner.column);
}

// Indices of the corners of a cell, counter-clockwise from the south-west corner.
std::array<std::size_t, 4> cornersOf(const maps::Grid& grid, maps::Cell cell) noexcept {
  const std::size_t south = cornerIndex(grid, cell), north = cornerIndex(grid, {cell.column, cell.row + 1});
  return {south, south + 1, north + 1, north};
}

// The corners around a place, where routes may begin or end: those of all cells within a distance.
std::vector<FieldGoal> cornersAround(const maps::Grid& grid, maps::Point place, double distance_m) {
  std::vector<FieldGoal> corners;
  for (const maps::Cell cell : cellsWithin(grid, place, distance_m))
    for (const maps::Cell step : {maps::Cell{0, 0}, {1, 0}, {0, 1}, {1, 1}})
      corners.push_back({{cell.column + step.column, cell.row + step.row}, 0.0});
  return corners;
}

// Lowest value [J] at some corners; 0 if none was reached.
double leastAt(const std::vector<float>& field, const maps::Grid& grid,
               const std::vector<FieldGoal>& corners) {
  float least = kFar;
  for (const FieldGoal& corner : corners) least = std::min(least, field[cornerIndex(grid, corner.cell)]);
  return std::isfinite(least) ? static_cast<double>(least) : 0.0;
}

// Increases per metre of a function over corners along the eight headings in a cell, the larger of both sides
// along a heading; empty if a corner has no value.
std::optional<Octagon> risesIn(const std::vector<float>& values, const maps::Grid& grid, maps::Cell cell) {
  std::array<double, 4> v;
  for (std::size_t k = 0; k < 4; ++k) {
    v[k] = static_cast<double>(values[cornersOf(grid, cell)[k]]) / grid.resolution_m;
    if (!std::isfinite(v[k])) return std::nullopt;
  }
  const auto rise = [&v](std::size_t a, std::size_t b) { return v[b] - v[a]; };
  const auto side = [](double a, double b) { return static_cast<float>(std::max(a, b)); };
  const auto across = [](double a) { return static_cast<float>(a / std::numbers::sqrt2); };
  return Octagon{
      side(rise(0, 1), rise(3, 2)), across(rise(0, 2)), side(rise(0, 3), rise(1, 2)), across(rise(1, 3)),
      side(rise(1, 0), rise(2, 3)), across(rise(2, 0)), side(rise(3, 0), rise(2, 1)), across(rise(3, 1))};
}

// Returns the lower bound [J] on a uniform map whose limit for each heading is the lowest of all cells; on a
// uniform map the optimal function is linear. Returns 0 as soon as the bound is at most `enough_J`.
double planeBound_J(const costmap::CostGrid& map, DirectionalCostBounds& of, const Segment& places,
                    double tolerance_m, double enough_J) {
  constexpr int kHeadings = DirectionalCostBounds::kHeadings;
  const double length_m = std::max(0.0, distance_m(places.from, places.to) - tolerance_m);
  const costmap::Direction way = directionOf(places);
  DirectionalCostBounds::Limits limits, least;
  least.fill(std::numeric_limits<float>::infinity());
  // Returns the cost [J/m] of the direction `way`, composed of the headings i and j; infinite if `way` does
  // not lie between them.
  const auto price = [&](int i, int j) {
    const costmap::Direction a = DirectionalCostBounds::heading(i), b = DirectionalCostBounds::heading(j);
    const double det = a.x * b.y - a.y * b.x, p = way.x * b.y - way.y * b.x, q = a.x * way.y - a.y * way.x;
    if (!(det > 1e-9) || p < 0.0 || q < 0.0) return kInfinity;
    return (p * static_cast<double>(least[static_cast<std::size_t>(i)]) +
            q * static_cast<double>(least[static_cast<std::size_t>(j)])) /
           det;
  };
  const auto over = [&] {
    double all = kInfinity;
    for (int i = 0; i < kHeadings; ++i)
      for (int j = 0; j < kHeadings; ++j) all = std::min(all, price(i, j));
    return all;
  };
  std::unordered_set<std::uint32_t> seen;
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column) {
      const costmap::CellCode code = map.at({column, row});
      if (!seen.insert(code.bits()).second || !of.of(code, limits)) continue;
      bool lower = false;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        lower = lower || limits[k] < least[k];
        least[k] = std::min(least[k], limits[k]);
      }
      if (lower && !(over() * length_m > enough_J)) return 0.0;
    }
  const double metre_J = over();
  return std::isfinite(metre_J) ? metre_J * length_m : 0.0;
}

}  // namespace

double LowerBound::operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                              double goal_tolerance_m, const StopCheck& stop, double known_J) {
  way_.clear();
  const double straight_J = straightBoundOver_J(*map, places, goal_tolerance_m, known_J, stop);
  if (straight_J >= (1.0 - kEven) * known_J) return straight_J;
  if (map != map_) {
    map_ = map;
    to_goal_.clear();
    octagons_.emplace(map->cost());
  }
  const auto starts = cornersAround(map->grid(), places.from, 0.0);
  if (to_goal_.empty() || !(goal_ == places.to) || tolerance_m_ != goal_tolerance_m) {
    goal_ = places.to;
    tolerance_m_ = goal_tolerance_m;
    to_goal_ = cornerField(map_, octagonOf(), cornersAround(map->grid(), goal_, tolerance_m_), stop);
  }
  if (to_goal_.empty()) return straight_J;
  double bound_J = std::max(straight_J, leastAt(to_goal_, map->grid(), starts));
  bound_J = std::max(bound_J, planeBound_J(*map_, octagons_->limits(), places, tolerance_m_, bound_J));
  if (bound_J >= (1.0 - kEven) * known_J) return std::min(known_J, bound_J);
  return std::min(known_J, std::max(bound_J, narrowed_J(places, starts, known_J, stop)));
}

OctagonOf LowerBound::octagonOf() {
  return [this](maps::Cell cell) { return octagons_->of(map_->at(cell)); };
}

// Removes the cells of a region in which no corner lies on a route of at most `known_J`.
void LowerBound::narrow(std::vector<bool>& region, const std::vector<float>& from_start,
                        double known_J) const {
  const maps::Grid& grid = map_->grid();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      bool inside = false;
      for (const std::size_t k : cornersOf(grid, {column, row}))
        inside = inside || static_cast<double>(from_start[k]) + static_cast<double>(to_goal_[k]) <= known_J;
      if (!inside) region[grid.index({column, row})] = false;
    }
}

double LowerBound::narrowed_J(const Segment& places, const std::vector<FieldGoal>& starts, double known_J,
                              const StopCheck& stop) {
  const maps::Grid& grid = map_->grid();
  auto from_start = cornerField(map_, octagonOf(), starts, stop, RouteSense::FromStart);
  if (from_start.empty()) return 0.0;
  std::vector<bool> region(grid.size(), true);
  narrow(region, from_start, known_J);
  const std::size_t quota =
      kNodes + static_cast<std::size_t>(kNodesPerCell * static_cast<double>(grid.size()));
  const SubSolution::Parts parts{map_, places, tolerance_m_, known_J, cheapestMetre_J(*map_)};
  SubSolution solution(parts, octagons_->limits(), region, quota, stop);
  way_ = solution.way();
  for (std::uint32_t k = 0; k < from_start.size(); ++k)
    from_start[k] = solution.fromStart(k) < SubSolution::kFar ? solution.fromStart(k) : kFar;
  const auto fitted = [&](maps::Cell cell) {
    Octagon octagon;
    octagon.fill(kFar);
    DirectionalCostBounds::Limits limits;
    if (!region[grid.index(cell)] || !octagons_->limits().of(map_->at(cell), limits)) return octagon;
    const auto rises = risesIn(from_start, grid, cell);
    return rises ? fittedOctagon(limits, *rises) : octagons_->of(map_->at(cell));
  };
  const auto ends = cornersAround(grid, goal_, tolerance_m_);
  const auto cells = static_cast<std::size_t>(std::ranges::count(region, true));
  double bound_J = 0.0;
  for (std::size_t work = 0; work == 0 || work + cells <= quota; work += cells) {
    from_start = cornerField(map_, fitted, starts, stop, RouteSense::FromStart);
    if (from_start.empty()) return bound_J;
    const double before_J = std::exchange(bound_J, std::max(bound_J, leastAt(from_start, grid, ends)));
    if (bound_J >= (1.0 - kEnough) * known_J) return bound_J;
    if (bound_J < (1.0 + kLeastGain) * before_J) break;
  }
  narrow(region, from_start, known_J);
  if (static_cast<std::size_t>(std::ranges::count(region, true)) > quota) return bound_J;
  solution.solve(std::move(region), quota);
  return std::max(bound_J, provenBy(solution, parts).bound_J);
}

}  // namespace talus::planner
