#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/bound/lower_bound.hpp>

namespace talus::planner {
namespace {

constexpr double kTubeCells = 4.0;  // standard deviation of samples beside the known route [cells]
constexpr int kTries = 100;

double uniform01(ImprovableRegion::Engine& engine) {
  return std::generate_canonical<double, 53>(engine);
}

std::vector<double> cumulativeLength(const std::vector<maps::Point>& route) {
  std::vector<double> metres;
  for (std::size_t i = 0; i < route.size(); ++i)
    metres.push_back(i == 0 ? 0.0 : metres.back() + distance_m(route[i - 1], route[i]));
  return metres;
}

}  // namespace

ImprovableRegion::ImprovableRegion(Parts parts)
    : parts_(std::move(parts)),
      motion_(parts_.map),
      cheapest_J_per_m_(planner::cheapestMetre_J(*parts_.map)),
      route_metres_(cumulativeLength(parts_.known_route)) {
  if (parts_.known_route.empty()) return;
  const maps::Grid& grid = parts_.map->grid();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const auto centre = grid.centre({column, row}); improves(centre, parts_.known_cost_J))
        cells_.push_back(static_cast<std::uint32_t>(grid.index({column, row})));
}

double ImprovableRegion::fromStart(maps::Point place) const {
  return between({parts_.start, place});
}

double ImprovableRegion::toGoal(maps::Point place) const {
  return std::max(0.0, distance_m(place, parts_.goal) - parts_.goal_tolerance_m) * cheapest_J_per_m_;
}

double ImprovableRegion::between(const Segment& ends) const {
  return distance_m(ends.from, ends.to) * cheapest_J_per_m_;
}

bool ImprovableRegion::improves(maps::Point place, double max_cost_J) const {
  return motion_.allowed(place) && fromStart(place) + toGoal(place) <= max_cost_J;
}

maps::Point ImprovableRegion::anywhere(Engine& engine) const {
  const maps::Grid& grid = parts_.map->grid();
  if (cells_.empty())
    return {grid.south_west.x_m + uniform01(engine) * grid.width * grid.resolution_m,
            grid.south_west.y_m + uniform01(engine) * grid.height * grid.resolution_m};
  const auto pick = static_cast<std::size_t>(uniform01(engine) * static_cast<double>(cells_.size()));
  const auto width = static_cast<std::uint32_t>(grid.width);
  const maps::Point centre =
      grid.centre({static_cast<int>(cells_[pick] % width), static_cast<int>(cells_[pick] / width)});
  const double dx = uniform01(engine) - 0.5;
  const double dy = uniform01(engine) - 0.5;
  return {centre.x_m + dx * grid.resolution_m, centre.y_m + dy * grid.resolution_m};
}

maps::Point ImprovableRegion::besideRoute(Engine& engine) const {
  const double metres = uniform01(engine) * route_metres_.back();
  const auto next = std::ranges::upper_bound(route_metres_, metres);
  const auto i = std::min(static_cast<std::size_t>(next - route_metres_.begin()), route_metres_.size() - 1);
  const maps::Point a = parts_.known_route[i - 1];
  const maps::Point b = parts_.known_route[i];
  const double t = (metres - route_metres_[i - 1]) / std::max(route_metres_[i] - route_metres_[i - 1], 1e-12);
  std::normal_distribution<double> aside(0.0, kTubeCells * parts_.map->grid().resolution_m);
  const double dx = aside(engine);
  const double dy = aside(engine);
  return {a.x_m + t * (b.x_m - a.x_m) + dx, a.y_m + t * (b.y_m - a.y_m) + dy};
}

bool ImprovableRegion::sample(Engine& engine, double max_cost_J, maps::Point& place) const {
  const bool route_known = route_metres_.size() > 1 && route_metres_.back() > 0;
  const double best_J = route_known ? std::min(max_cost_J, parts_.known_cost_J) : max_cost_J;
  for (int i = 0; i < kTries; ++i) {
    place = route_known && uniform01(engine) < 0.5 ? besideRoute(engine) : anywhere(engine);
    if (improves(place, best_J)) return true;
  }
  return false;
}

}  // namespace talus::planner
