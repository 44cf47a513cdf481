#include <algorithm>
#include <cmath>
#include <random>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/point_route.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace lower_bound_test {

using testing::drawn;
using testing::randomMap;

// Property: no route costs less than the bound; the refined best route of the planner is the strictest
// check.
TEST(LowerBound, BoundIsBelowEveryPlannedRoute) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const auto map =
        randomMap({.width = 40, .height = 30, .seed = seed, .blocked = 0.1, .roughness = 0.02 * (seed % 12)});
    FieldPlanner planner({.corridor = {.reach_cells = 6, .points_per_edge = 6}, .slides = 6});
    for (const maps::Point start : {maps::Point{2.3, 2.7}, maps::Point{39.9, 0.1}}) {
      const Problem asked{.map = map, .start = start, .goal = {20.2, 27.9}, .prove = false};
      const Plan plan = planner.plan(asked);
      if (plan.status != RouteStatus::Found) continue;
      const double bound = LowerBound()(map, {asked.start, asked.goal}, 0.0);
      EXPECT_LE(bound, plan.cost_J) << seed;
      EXPECT_GT(bound, 0.0);
    }
  }
}

// Property: every planned route through a random place that costs at most the stated cost stays in the corridor, which
// leaves cells out.
TEST(LowerBound, CorridorContainsEveryRouteOfItsCost) {
  int inside = 0, outside = 0, left_out = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    // Every second map is level ground, on which the corridor is tight.
    const auto map =
        seed % 2 == 0 ? randomMap({.width = 40, .height = 30, .seed = seed, .blocked = 0.1, .roughness = 0.1})
                      : drawn(std::vector<std::string>(30, std::string(40, '.')));
    FieldPlanner planner;
    Problem asked{.map = map, .start = {2.3, 2.7}, .goal = {35.2, 27.9}};
    const Plan best = planner.plan(asked);
    if (best.status != RouteStatus::Found) continue;
    const double most_J = 1.1 * best.cost_J;
    const auto corridor = LowerBound().corridor(map, {asked.start, asked.goal}, 0.0, most_J);
    ASSERT_EQ(corridor.size(), map->grid().size());
    left_out += static_cast<int>(std::ranges::count(corridor, false));
    std::mt19937 random(seed);
    for (int k = 0; k < 60; ++k) {
      asked.via = {{0.1 * static_cast<double>(random() % 400), 0.1 * static_cast<double>(random() % 300)}};
      const Plan plan = planner.plan(asked);
      if (plan.status != RouteStatus::Found || plan.cost_J > most_J) {
        ++outside;
        continue;
      }
      ++inside;
      for (const maps::Point vertex : plan.points)
        EXPECT_TRUE(corridor[map->grid().index(*map->grid().cellAt(vertex))]) << seed << ' ' << k;
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(outside, 10);
  EXPECT_GT(left_out, 100);
}

// Ramps of one gradient and soil, 20 cells wide: ground on which the bound is close to the cost.
std::shared_ptr<const costmap::CostGrid> ramps(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<costmap::CellCode> patches;
  const auto gradient = [&random] { return (static_cast<int>(random() % 400) - 200) / 1024.0; };
  for (int k = 0; k < 16; ++k)
    patches.push_back(costmap::CellCode(
        {.dz_dx = gradient(), .dz_dy = gradient(), .curve = static_cast<std::uint8_t>(random() % 3)}));
  maps::Raster<costmap::CellCode> cells({.width = 80, .height = 80, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column)
      cells[{column, row}] = patches[static_cast<std::size_t>(row / 20 * 4 + column / 20)];
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
}

// Property: no random allowed motion costs less than the bound, straight or with one bend, of any length and
// heading, also along the map's border.
TEST(LowerBound, BoundIsBelowRandomMotions) {
  int tried = 0, sharp = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto map = ramps(seed);
    const MotionCost cost(map);
    std::mt19937 random(seed);
    const auto place = [&random] {
      return maps::Point{static_cast<double>(random() % 801) / 10, static_cast<double>(random() % 801) / 10};
    };
    for (int g = 0; g < 6; ++g) {
      const maps::Point goal = place(), start = place();
      const double bound_J = LowerBound()(map, {start, goal}, 0.0);
      double least_J = cost({start, goal});
      for (int k = 0; k < 4'000; ++k) {
        const double cost_J =
            k % 2 == 0 ? cost.along({start, place(), goal}) : cost.along({start, place(), place(), goal});
        if (!std::isfinite(cost_J)) continue;
        ASSERT_LE(bound_J, cost_J * (1 + 1e-9)) << seed << " " << g << " " << k;
        least_J = std::min(least_J, cost_J);
        ++tried;
      }
      if (bound_J > 0.8 * least_J) ++sharp;
    }
  }
  EXPECT_GT(tried, 10'000);
  EXPECT_GT(sharp, 20);
}

// Closed form: 10 J/m; a bound over corners of cells alone would be up to 7.6 % too low.
TEST(LowerBound, BoundEqualsStraightLineCostOnUniformGround) {
  const auto map = drawn(std::vector<std::string>(200, std::string(200, '.')));
  const Segment ends{{10.5, 10.5}, {190.5, 80.5}};
  const double best = 10.0 * std::hypot(180.0, 70.0);
  EXPECT_NEAR(LowerBound()(map, ends, 0.0), best, 1e-9 * best);
}

TEST(LowerBound, ToleranceLowersTheBound) {
  const auto map = drawn(std::vector<std::string>(60, std::string(60, '.')));
  const Segment ends{{5.5, 5.5}, {50.5, 50.5}};
  EXPECT_LT(LowerBound()(map, ends, 20.0), LowerBound()(map, ends, 0.0));
}

// Closed form: 50 m along a track of 1 J/m cost 50 J, although climbing on the track costs a thousand times
// as much and the ground beside the track ten times as much.
TEST(LowerBound, BoundIsValidIfSlopeCostDominatesRollingCost) {
  costmap::TravelCurve track, ground;
  ground.cost_J_per_m.fill(10.0F);
  for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin)
    track.cost_J_per_m[static_cast<std::size_t>(bin)] =
        static_cast<float>(std::max(0.1, 1.0 + 1000.0 * costmap::TravelCurve::gradient(bin)));
  maps::Raster<costmap::CellCode> cells({.width = 60, .height = 20, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.curve = 1}));
  for (int column = 0; column < 60; ++column) cells[{column, 10}] = costmap::CellCode({.curve = 0});
  const auto cost =
      std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{track, ground});
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
  const Segment ends{{5.5, 10.5}, {55.5, 10.5}};
  EXPECT_NEAR(MotionCost(map)(ends), 50.0, 1e-6);
  EXPECT_LE(LowerBound()(map, ends, 0.0), 50.0);
}

std::shared_ptr<const costmap::CostGrid> randomGround(
    unsigned seed, const std::shared_ptr<const costmap::TravelCost>& cost) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  maps::Raster<costmap::CellCode> cells(
      {.width = 24, .height = 17, .resolution_m = 2.0, .south_west = {-7.0, 3.0}});
  for (auto& cell : cells.values())
    cell = costmap::CellCode({.dz_dx = 0.12 * (2 * unit() - 1),
                              .dz_dy = 0.12 * (2 * unit() - 1),
                              .curve = unit() < 0.1 ? costmap::CellCode::kBlocked
                                                    : static_cast<costmap::CellCode::Curve>(3 * unit())});
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
}

// Property: the bound for a known cost, in the region of its routes, is at most the known cost and at most the
// cost of the route over points of cells; on ground of uncorrelated cells, where single headings are allowed.
TEST(LowerBound, KnownCostNarrowsTheSearchSoundly) {
  int found = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const auto map = randomGround(seed, seed % 2 == 0 ? testing::jaggedCost() : testing::driveCost());
    const Segment ends{{-3.3, 5.1}, {30.7, 25.2}};
    const MotionCost cost(map);
    if (!cost.allowed(ends.from) || !cost.allowed(ends.to)) continue;
    const double whole_J = LowerBound()(map, ends, 0.0);
    const double along_J = cost.ofLegs(pointRoute(cost, ends, 0.0, kInfinity));
    if (!std::isfinite(along_J)) continue;
    EXPECT_LE(whole_J, along_J) << seed;
    for (const double known_J : {1.01 * whole_J, 1.1 * whole_J, along_J, 2.0 * along_J}) {
      const double near_J = LowerBound()(map, ends, 0.0, {}, known_J);
      EXPECT_LE(near_J, std::min(known_J, along_J)) << seed;
    }
    ++found;
  }
  EXPECT_GT(found, 5);
}

}  // namespace lower_bound_test
}  // namespace talus::planner
