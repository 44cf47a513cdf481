#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/lower_bound.hpp>

namespace talus::planner {
namespace {

// All corners of cells within so many cells of a place, by column and by row.
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

// The corners of a place's cell, of both its cells where it lies on an edge, are no farther away.
constexpr double kSquare = 1.001;

}  // namespace

double LowerBound::operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                              double goal_tolerance_m, const StopCheck& stop, double known_J) {
  const maps::Grid& grid = map->grid();
  const double straight_J = straightBoundOver_J(*map, places, goal_tolerance_m, known_J, stop);
  if (straight_J >= (1.0 - kEven) * known_J) return straight_J;
  if (map != map_ || !edges_) {
    field_.reset();
    map_ = map;
    edges_ = admissibleEdges(map, stop);
  }
  if (!edges_) return straight_J;
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
    if (!field_->settle(corner, stop)) return straight_J;
    least_J = std::min(least_J, field_->cost_J(corner).value_or(least_J));
  }
  return std::isfinite(least_J) ? std::min(known_J, std::max(least_J, straight_J)) : straight_J;
}

}  // namespace talus::planner
