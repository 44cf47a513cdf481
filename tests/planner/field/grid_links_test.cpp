#include <cmath>
#include <set>

#include <talus/planner/field/grid_links.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace grid_links_test {

using testing::drawn;
using testing::randomMap;

// Property: links are all cells whose centre is at most one cell away in column and row and that the exact
// motion reaches, at its cost; the cost there and that back are separate.
TEST(GridLinks, LinksAreTheAllowedMotionsToNeighbours) {
  int found = 0, uneven = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const MotionCost cost(randomMap({.width = 9, .height = 7, .seed = seed, .roughness = 0.4}));
    const maps::Grid& grid = cost.map().grid();
    for (const maps::Point place : {maps::Point{4.3, 3.6}, {0.1, 6.9}, {8.9, 0.2}, {3.0, 2.5}}) {
      const auto from = linksFrom(cost, place), to = linksTo(cost, place);
      std::size_t expected_from = 0, expected_to = 0;
      const maps::Cell own = *grid.cellAt(place);
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 9; ++column) {
          if (std::abs(row - own.row) > 1 || std::abs(column - own.column) > 1) continue;
          const maps::Point centre = grid.centre({column, row});
          expected_from += std::isfinite(cost({place, centre}));
          expected_to += std::isfinite(cost({centre, place}));
        }
      ASSERT_EQ(from.size(), expected_from);
      ASSERT_EQ(to.size(), expected_to);
      for (const GridLink& link : from) EXPECT_EQ(link.cost_J, cost({place, grid.centre(link.cell)}));
      for (const GridLink& link : to) EXPECT_EQ(link.cost_J, cost({grid.centre(link.cell), place}));
      found += static_cast<int>(from.size());
      uneven += !from.empty() && !to.empty() && from[0].cost_J != to[0].cost_J;
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(uneven, 5);
}

TEST(GridLinks, PlacesOutsideTheMapHaveNoLinks) {
  const MotionCost cost(drawn({"...", "..."}));
  EXPECT_TRUE(linksFrom(cost, {-0.1, 0.5}).empty());
  EXPECT_TRUE(linksTo(cost, {1.5, 2.0}).empty());
}

// Property: the goal cells, with cost 0, are all cells whose centres lie in the circle, also around a goal
// off the map; by brute force.
TEST(GridLinks, GoalCellsAreAllAllowedCellsWithinTolerance) {
  const auto map = randomMap({.width = 25, .height = 19, .seed = 3, .blocked = 0.3});
  const MotionCost cost(map);
  for (const maps::Point goal : {maps::Point{12.2, 9.9}, {0.5, 0.5}, {24.9, 18.9}, {-2.0, 10.0}})
    for (const double tolerance_m : {0.0, 0.6, 3.0, 7.7}) {
      std::set<std::pair<int, int>> expected, found;
      for (int row = 0; row < 19; ++row)
        for (int column = 0; column < 25; ++column) {
          const maps::Point centre = map->grid().centre({column, row});
          const double away_m = std::hypot(centre.x_m - goal.x_m, centre.y_m - goal.y_m);
          if (tolerance_m > 0.0 && away_m <= tolerance_m && cost.allowed(centre))
            expected.emplace(column, row);
        }
      const auto goals = fieldGoals(cost, goal, tolerance_m);
      const std::size_t links = linksTo(cost, goal).size();
      ASSERT_GE(goals.size(), links);
      for (std::size_t k = links; k < goals.size(); ++k) {
        EXPECT_EQ(goals[k].cost_J, 0.0);
        found.emplace(goals[k].cell.column, goals[k].cell.row);
      }
      EXPECT_EQ(found, expected) << goal.x_m << " " << tolerance_m;
    }
}

}  // namespace grid_links_test
}  // namespace talus::planner
