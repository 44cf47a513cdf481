#include <cmath>
#include <random>

#include <talus/planner/sampling/map_validity.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
namespace map_validity_test {

namespace ob = ompl::base;

const Segment kEnds{{0.5, 0.5}, {1.5, 0.5}};

// Property: OMPL's validity equals that of the one cost function for each place and motion, and the checks
// are counted.
TEST(MapValidity, ValidityEqualsFiniteMotionCost) {
  const testing::OmplGround ground(testing::randomMap({.seed = 11, .blocked = 0.2, .roughness = 0.3}), kEnds);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(0.0, 20.0), short_way(0.0, 0.9);
  unsigned valid = 0, invalid = 0;
  for (int k = 0; k < 3'000; ++k) {
    const maps::Point a{side(random), side(random)},
        b{a.x_m + short_way(random), std::min(a.y_m + 0.3, 19.9)};
    EXPECT_EQ(ground.space->isValid(ground.at(a).get()), ground.cost->motion().allowed(a));
    const bool allowed = std::isfinite((*ground.cost)({a, b}));
    EXPECT_EQ(ground.space->checkMotion(ground.at(a).get(), ground.at(b).get()), allowed);
    ++(allowed ? valid : invalid);
  }
  EXPECT_GT(valid, 300U);
  EXPECT_GT(invalid, 300U);
  EXPECT_EQ(ground.motions->getValidMotionCount(), valid);
  EXPECT_EQ(ground.motions->getInvalidMotionCount(), invalid);
}

// Closed form: from x = 0.5 m eastwards a wall at 6 m blocks the motion after 5.5 of 10 m; bisection is
// accurate to 1/256.
TEST(MapValidity, LastValidStateIsFoundByBisection) {
  const testing::OmplGround ground(testing::drawn({"......#....", "......#...."}), kEnds);
  const auto from = ground.at({0.5, 0.5}), to = ground.at({10.5, 0.5});
  auto last = ground.at({0.0, 0.0});
  std::pair<ob::State*, double> reached{last.get(), 0.0};
  EXPECT_FALSE(ground.space->checkMotion(from.get(), to.get(), reached));
  EXPECT_LE(reached.second, 0.55);
  EXPECT_GT(reached.second, 0.55 - 2.0 / 256);
  EXPECT_NEAR(MapSpace::place(last.get()).x_m, 0.5 + 10 * reached.second, 1e-9);
  const auto before = ground.at({5.5, 0.5});
  EXPECT_TRUE(ground.space->checkMotion(from.get(), before.get(), reached));
}

}  // namespace map_validity_test
}  // namespace talus::planner
