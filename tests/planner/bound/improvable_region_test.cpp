#include <cmath>

#include <talus/planner/bound/improvable_region.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace improvable_region_test {

using testing::drawn;
using testing::randomMap;

const std::vector<std::string> kFlat(30, std::string(40, '.'));

ImprovableRegion around(double known_J, double tolerance_m = 0.0) {
  return ImprovableRegion({.map = drawn(kFlat),
                           .start = {10.5, 15.5},
                           .goal = {30.5, 15.5},
                           .goal_tolerance_m = tolerance_m,
                           .known_route = {{10.5, 15.5}, {20.5, 19.5}, {30.5, 15.5}},
                           .known_cost_J = known_J});
}

// Closed form: at 10 J/m the region for a route of 25 m is an ellipse with foci 20 m apart.
TEST(ImprovableRegion, RegionIsAnEllipseOnUniformGround) {
  const auto region = around(250.0);
  int inside = 0;
  for (double x = 0.25; x < 40.0; x += 0.5)
    for (double y = 0.25; y < 30.0; y += 0.5) {
      const double away_m = std::hypot(x - 10.5, y - 15.5) + std::hypot(x - 30.5, y - 15.5);
      ASSERT_EQ(region.improves({x, y}, 250.0), away_m <= 25.0) << x << " " << y;
      inside += away_m <= 25.0;
    }
  EXPECT_GT(inside, 500);
  EXPECT_NEAR(around(250.0, 4.0).toGoal({20.5, 15.5}), 60.0, 1e-4);  // 10 m less a tolerance of 4 m
  EXPECT_EQ(around(250.0, 4.0).toGoal({29.5, 15.5}), 0.0);
}

// Property: the bounds are below the cost of every allowed motion.
TEST(ImprovableRegion, BoundsAreBelowTheCost) {
  const auto map = randomMap({.seed = 9, .blocked = 0.05});
  const ImprovableRegion region({.map = map, .start = {3.5, 3.5}, .goal = {16.5, 15.5}, .known_route = {}});
  const MotionCost cost(map);
  int tried = 0;
  for (int k = 0; k < 400; ++k) {
    const maps::Point place = map->grid().centre({k % 20, k / 20});
    tried += std::isfinite(cost({place, {16.5, 15.5}}));
    EXPECT_LE(region.toGoal(place), cost({place, {16.5, 15.5}}) * (1 + 1e-9));
    EXPECT_LE(region.fromStart(place), cost({{3.5, 3.5}, place}) * (1 + 1e-9));
    EXPECT_EQ(region.between({{3.5, 3.5}, place}), region.fromStart(place));
  }
  EXPECT_GT(tried, 50);
}

// Property: every sample can be on a route cheaper than the best cost, also for a best cost below that of
// the known route. The samples reach every quarter of the ellipse, and an equal engine gives equal samples.
TEST(ImprovableRegion, SamplesCoverTheRegion) {
  const auto region = around(250.0);
  for (const double best_J : {250.0, 215.0, 1e9}) {
    ImprovableRegion::Engine engine(4), again(4);
    int quarters[4] = {};
    for (int k = 0; k < 2'000; ++k) {
      maps::Point place, other;
      ASSERT_TRUE(region.sample(engine, best_J, place));
      ASSERT_TRUE(region.sample(again, best_J, other));
      EXPECT_EQ(place, other);
      EXPECT_TRUE(region.improves(place, std::min(best_J, 250.0)));
      ++quarters[(place.x_m > 20.5) + 2 * (place.y_m > 15.5)];
    }
    for (const int count : quarters) EXPECT_GT(count, 100) << best_J;
  }
}

TEST(ImprovableRegion, NoSampleExistsIfNoImprovementIsPossible) {
  ImprovableRegion::Engine engine(1);
  maps::Point place;
  EXPECT_FALSE(around(250.0).sample(engine, 199.0, place));  // Closed form: 20 m at 10 J
}

}  // namespace improvable_region_test
}  // namespace talus::planner
