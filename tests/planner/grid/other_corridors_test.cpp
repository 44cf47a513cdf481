#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <talus/planner/field/grid_links.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/other_corridors.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace other_corridors_test {

// A wall that no heading enters, with gaps of free ground; the ground on both sides is free.
std::vector<std::string> wallWithGaps(int width, int height, std::initializer_list<int> gaps) {
  std::vector<std::string> rows(static_cast<std::size_t>(height),
                                std::string(static_cast<std::size_t>(width), '.'));
  for (int row = 0; row < height; ++row) {
    const bool open =
        std::any_of(gaps.begin(), gaps.end(), [&](int gap) { return std::abs(gap - row) <= 1; });
    if (!open) rows[static_cast<std::size_t>(row)].replace(30, 20, std::string(20, '#'));
  }
  return rows;
}

std::vector<Polyline> others(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                             const CorridorChoice& choice = {}) {
  const MotionCost cost(map);
  const auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), map->grid().resolution_m, 1.0));
  CostToGo field(edges, fieldGoals(cost, places.to, 0.0));
  return otherCorridors(cost, map, field, places, gridRoute(cost, field, places), choice);
}

// Closed form: the route takes the middle one of three gaps; each of the other two is tried once.
TEST(OtherCorridors, AlternativesUseTheOtherGapsOfAWall) {
  const auto map = testing::drawn(wallWithGaps(80, 60, {10, 30, 50}));
  const Segment places{{3.5, 30.5}, {76.5, 30.5}};
  const auto found = others(map, places, {.most = 9, .within = 0.5});
  const MotionCost cost(map);
  std::array<int, 3> through{};
  for (const Polyline& route : found) {
    EXPECT_EQ(route.front(), places.from);
    EXPECT_EQ(route.back(), places.to);
    EXPECT_TRUE(std::isfinite(cost.along(route)));
    for (const maps::Point p : route)
      if (std::abs(p.x_m - 40.5) < 0.1) ++through[static_cast<std::size_t>(p.y_m / 20.0)];
  }
  EXPECT_EQ(through[0], 1);
  EXPECT_EQ(through[2], 1);
  EXPECT_EQ(others(map, places, {.most = 1, .within = 0.5}).size(), 1U);
  EXPECT_TRUE(others(map, places, {.within = 0.01}).empty());
}

// Property: every corridor is allowed and within the requested share of the best grid route. Reversing the
// heading on inverted ground leaves the cost unchanged, so that both directions can be compared.
TEST(OtherCorridors, AlternativesAreWithinTheCostShare) {
  int found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto map =
        testing::randomMap({.width = 60, .height = 60, .seed = seed, .blocked = 0.15, .roughness = 0.2});
    const MotionCost cost(map);
    const Segment places{{3.5, 3.5}, {56.5, 56.5}};
    if (!cost.allowed(places.from) || !cost.allowed(places.to)) continue;
    const auto edges =
        std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), map->grid().resolution_m, 1.0));
    CostToGo field(edges, fieldGoals(cost, places.to, 0.0));
    const Polyline best = gridRoute(cost, field, places);
    if (best.empty()) continue;
    for (const Polyline& route : otherCorridors(cost, map, field, places, best, {.most = 3, .within = 0.1})) {
      ++found;
      EXPECT_TRUE(std::isfinite(cost.along(route))) << seed;
      EXPECT_LT(cost.along(route), 1.12 * cost.along(best))
          << seed;  // whole units and links of the ends: 2 %
    }
  }
  EXPECT_GT(found, 5) << found;
}

// Level ground with blocks that no heading enters.
std::shared_ptr<const costmap::CostGrid> blocks(unsigned seed) {
  std::mt19937 random(seed);
  const auto upTo = [&random](unsigned most) { return static_cast<std::size_t>(random() % most); };
  std::vector<std::string> rows(100, std::string(100, '.'));
  for (int k = 0; k < 60; ++k) {
    const std::size_t x = 6 + upTo(80), y = 6 + upTo(80), width = 3 + upTo(8), height = 3 + upTo(8);
    for (std::size_t row = y; row < std::min<std::size_t>(y + height, 94); ++row)
      rows[row].replace(x, width, std::string(width, '#'));
  }
  return testing::drawn(rows);
}

// Property: with other corridors a route never costs more, and costs less in some cases in which the eight
// grid headings rank the corridors between blocks incorrectly.
TEST(OtherCorridors, AlternativesNeverIncreaseTheRouteCost) {
  int cheaper = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Problem problem{.map = blocks(seed), .start = {2.5, 14.5}, .goal = {97.5, 61.5}, .prove = false};
    const Plan one = FieldPlanner().plan(problem);
    problem.prove = true;
    const Plan several = FieldPlanner().plan(problem);
    ASSERT_EQ(one.status, several.status) << seed;
    if (one.status != RouteStatus::Found) continue;
    EXPECT_LE(several.cost_J, one.cost_J) << seed;
    EXPECT_LE(several.lower_bound_J, several.cost_J) << seed;
    if (several.cost_J < 0.999 * one.cost_J) ++cheaper;
  }
  EXPECT_GT(cheaper, 0);
}

}  // namespace other_corridors_test
}  // namespace talus::planner
