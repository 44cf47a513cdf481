#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>

#include <talus/planner/sampling/map_space.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
namespace map_space_test {

const maps::Grid kGrid{.width = 40, .height = 30, .resolution_m = 2.5, .south_west = {-7.0, 1000.0}};

// Property: every place within the bounds, including the corners, lies in a cell of the map; a place outside
// is moved to the nearest of them.
TEST(MapSpace, PlacesWithinBoundsLieOnTheMap) {
  const auto space = std::make_shared<MapSpace>(kGrid);
  space->setup();
  ompl::base::ScopedState<MapSpace> state(space);
  for (const maps::Point place : {maps::Point{-99.0, -99.0}, {1e9, 1e9}, {-7.0, 1075.0}, {93.0, 1000.0}}) {
    MapSpace::setPlace(state.get(), place);
    space->enforceBounds(state.get());
    EXPECT_TRUE(kGrid.cellAt(MapSpace::place(state.get()))) << place.x_m << "," << place.y_m;
  }
  MapSpace::setPlace(state.get(), {1e9, 1030.0});
  space->enforceBounds(state.get());
  EXPECT_NEAR(MapSpace::place(state.get()).x_m, 93.0, 1e-9);  // Closed form: -7 + 40 * 2.5
  EXPECT_EQ(MapSpace::place(state.get()).y_m, 1030.0);
}

using testing::drawn;
using testing::randomMap;

// Property: the value is that of MotionCost if a route may turn at both ends, else infinite. Finite motions
// joined at any such place form an allowed route.
TEST(MeteredCost, CostEqualsMotionCostAtValidTurns) {
  const auto map = randomMap({.seed = 4, .blocked = 0.1, .roughness = 0.3});
  const MotionCost exact(map);
  const MeteredCost cost(map, {{0.5, 0.5}, {19.5, 19.5}});
  std::mt19937 random(2);
  // Multiples of half a metre: half of the places lie on an edge, a quarter on a corner.
  const auto place = [&random] {
    return maps::Point{0.5 * static_cast<double>(random() % 41), 0.5 * static_cast<double>(random() % 41)};
  };
  int finite = 0, joined = 0;
  for (int k = 0; k < 20'000; ++k) {
    const maps::Point a = place(), b{a.x_m + 0.5 * static_cast<double>(random() % 5), a.y_m + 0.5},
                      c = place();
    const double first = cost({a, b}), second = cost({b, c});
    if (!std::isfinite(first)) continue;
    ++finite;
    EXPECT_EQ(first, exact({a, b}));
    if (!std::isfinite(second)) continue;
    ++joined;
    EXPECT_TRUE(std::isfinite(exact.along({a, b, c})));
  }
  EXPECT_GT(finite, 1'000);
  EXPECT_GT(joined, 20);
}

// Closed form: a call counts one plus the cells of its length, 1 + 3 for 3.5 m; an immediate repetition
// counts nothing, an iteration a hundred.
TEST(MeteredCost, WorkCountsCellLengths) {
  const MeteredCost cost(drawn({".....", "....."}), {{0.5, 0.5}, {4.5, 0.5}});
  EXPECT_EQ(cost.work(), 0U);
  EXPECT_NEAR(cost({{0.5, 0.5}, {4.0, 0.5}}), 35.0, 1e-6);
  EXPECT_EQ(cost.work(), 4U);
  EXPECT_NEAR(cost({{0.5, 0.5}, {4.0, 0.5}}), 35.0, 1e-6);
  EXPECT_EQ(cost.work(), 4U);
  cost({{4.0, 0.5}, {0.5, 0.5}});
  cost.iterated();
  EXPECT_EQ(cost.work(), 108U);
}

// Property: start and goal of the problem are no turns and may lie on an edge beside blocked ground.
TEST(MeteredCost, StartAndGoalAreNotTreatedAsTurns) {
  const auto map = drawn({"##", ".."});
  const Segment up{{0.5, 1.0}, {1.5, 0.5}};
  EXPECT_TRUE(std::isinf(MeteredCost(map, {{0.1, 0.1}, {1.9, 0.1}})(up)));
  EXPECT_TRUE(std::isfinite(MotionCost(map)(up)));
  EXPECT_EQ(MeteredCost(map, {up.from, up.to})(up), MotionCost(map)(up));
}

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

}  // namespace map_space_test
}  // namespace talus::planner
