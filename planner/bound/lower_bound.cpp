#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/cheapest_metre.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution_check.hpp>

namespace talus::planner {
namespace {

// All cell corners within a distance of `cells` cells of a place, per axis.
std::vector<maps::Cell> cornersWithin(const maps::Grid& grid, maps::Point place, double cells) {
  std::vector<maps::Cell> found;
  const double column = (place.x_m - grid.south_west.x_m) / grid.resolution_m;
  const double row = (place.y_m - grid.south_west.y_m) / grid.resolution_m;
  const auto from = [cells](double at) { return static_cast<int>(std::max(std::ceil(at - cells), 0.0)); };
  const auto to = [cells](double at, int count) {
    return static_cast<int>(std::min(std::floor(at + cells), static_cast<double>(count)));
  };
  for (int r = from(row); r <= to(row, grid.height); ++r)
    for (int c = from(column); c <= to(column, grid.width); ++c) found.push_back({c, r});
  return found;
}

// Returns the lower bound [J] on a uniform map whose limit for each heading is the lowest of all cells; on a
// uniform map the optimal function is linear. Returns 0 as soon as the bound is at most `enough_J`.
double planeBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                    double enough_J) {
  constexpr int kHeadings = DirectionalCostBounds::kHeadings;
  const double length_m = std::max(0.0, distance_m(places.from, places.to) - tolerance_m);
  const costmap::Direction way = directionOf(places);
  DirectionalCostBounds of(map.cost());
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

// Radius [cells] that contains the corners of the cell of a place, or of both cells if the place lies on an
// edge.
constexpr double kSquare = 1.001;

}  // namespace

double LowerBound::operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                              double goal_tolerance_m, const StopCheck& stop, double known_J) {
  way_.clear();
  const double straight_J = straightBoundOver_J(*map, places, goal_tolerance_m, known_J, stop);
  if (straight_J >= (1.0 - kEven) * known_J) return straight_J;
  double bound_J = 0.0;
  if (map->grid().size() > kSmall) {
    bound_J = overEdges_J(map, places, goal_tolerance_m, stop);
  } else if (const double cheapest_J = cheapestMetre_J(*map); cheapest_J > 0.0) {
    const SubSolution::Parts parts{map, places, goal_tolerance_m, known_J, cheapest_J};
    const SubSolution solution(parts, stop);
    bound_J = provenBy(solution, parts).bound_J;
    way_ = solution.way();
    bound_J = std::max(bound_J, planeBound_J(*map, places, goal_tolerance_m, std::max(bound_J, straight_J)));
  }
  return std::min(known_J, std::max(bound_J, straight_J));
}

// Returns 0 when stopped, or if the lower bound of some step is 0.
double LowerBound::overEdges_J(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                               double goal_tolerance_m, const StopCheck& stop) {
  const maps::Grid& grid = map->grid();
  if (map != map_ || !edges_) {
    field_.reset();
    map_ = map;
    edges_ = admissibleEdges(map, stop);
  }
  if (!edges_) return 0.0;
  if (!field_ || !(goal_ == places.to) || tolerance_m_ != goal_tolerance_m) {
    std::vector<FieldGoal> goals;
    for (const maps::Cell corner :
         cornersWithin(grid, places.to, kSquare + goal_tolerance_m / grid.resolution_m))
      goals.push_back({corner, 0.0});
    field_.emplace(edges_, goals);
    goal_ = places.to;
    tolerance_m_ = goal_tolerance_m;
  }
  double least_J = std::numeric_limits<double>::infinity();
  for (const maps::Cell corner : cornersWithin(grid, places.from, kSquare)) {
    if (!field_->settle(corner, stop)) return 0.0;
    least_J = std::min(least_J, field_->cost_J(corner).value_or(least_J));
  }
  return std::isfinite(least_J) ? least_J : 0.0;
}

}  // namespace talus::planner
