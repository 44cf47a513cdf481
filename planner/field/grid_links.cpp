#include <cmath>

#include <talus/planner/field/grid_links.hpp>

namespace talus::planner {
namespace {

template <typename Motion>
std::vector<GridLink> links(const MotionCost& cost, maps::Point place, Motion motion) {
  std::vector<GridLink> found;
  const maps::Grid& grid = cost.map().grid();
  const auto own = grid.cellAt(place);
  if (!own) return found;
  for (int row = own->row - 1; row <= own->row + 1; ++row)
    for (int column = own->column - 1; column <= own->column + 1; ++column) {
      const maps::Cell cell{column, row};
      if (!grid.contains(cell)) continue;
      const double link_J = cost(motion(grid.centre(cell)));
      if (std::isfinite(link_J)) found.push_back({cell, link_J});
    }
  return found;
}

}  // namespace

std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place) {
  return links(cost, place, [place](maps::Point centre) { return Segment{place, centre}; });
}

std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place) {
  return links(cost, place, [place](maps::Point centre) { return Segment{centre, place}; });
}

std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m) {
  std::vector<FieldGoal> goals;
  for (const GridLink& link : linksTo(cost, goal)) goals.push_back({link.cell, link.cost_J});
  const maps::Grid& grid = cost.map().grid();
  const double reach = tolerance_m / grid.resolution_m;
  const auto lowest = [reach](double origin, double at, double side) {
    return static_cast<int>(std::max(0.0, std::floor((at - origin) / side - reach - 1)));
  };
  const auto highest = [reach](double origin, double at, double side, int count) {
    return static_cast<int>(std::min(count - 1.0, std::ceil((at - origin) / side + reach + 1)));
  };
  if (!(tolerance_m > 0.0)) return goals;
  const int last_row = highest(grid.south_west.y_m, goal.y_m, grid.resolution_m, grid.height);
  const int last_column = highest(grid.south_west.x_m, goal.x_m, grid.resolution_m, grid.width);
  for (int row = lowest(grid.south_west.y_m, goal.y_m, grid.resolution_m); row <= last_row; ++row)
    for (int column = lowest(grid.south_west.x_m, goal.x_m, grid.resolution_m); column <= last_column;
         ++column) {
      const maps::Point centre = grid.centre({column, row});
      const bool near = std::hypot(centre.x_m - goal.x_m, centre.y_m - goal.y_m) <= tolerance_m;
      if (near && cost.allowed(centre)) goals.push_back({{column, row}, 0.0});
    }
  return goals;
}

}  // namespace talus::planner
