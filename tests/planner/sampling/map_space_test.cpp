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

namespace travel_objective_test {

namespace ob = ompl::base;

std::shared_ptr<const ImprovableRegion> regionOf(bool hand_out) {
  return std::make_shared<ImprovableRegion>(
      ImprovableRegion::Parts{.map = testing::drawn(std::vector<std::string>(30, std::string(40, '.'))),
                              .start = {10.5, 15.5},
                              .goal = {30.5, 15.5},
                              .known_route = {{10.5, 15.5}, {20.5, 19.5}, {30.5, 15.5}},
                              .known_cost_J = 250.0,
                              .hand_out_route = hand_out});
}

// Property: on request the points of the known route come first, in order, then samples of the region.
TEST(RegionSampler, KnownRouteIsSampledFirst) {
  const auto region = regionOf(true);
  RegionSource source(region, 1), plain(regionOf(false), 1);
  maps::Point place;
  for (const maps::Point known : region->parts().known_route) {
    ASSERT_TRUE(source.next(250.0, place));
    EXPECT_EQ(place, known);
  }
  maps::Point first;
  ASSERT_TRUE(source.next(250.0, place) && plain.next(250.0, first));
  EXPECT_EQ(place, first);
  EXPECT_TRUE(region->improves(place, 250.0));
}

// Property: equal seeds give equal states, other seeds others. All states lie within the bounds, and states
// near another state lie within the given distance in x and y.
TEST(RegionSampler, SamplesAreReproducibleAndWithinBounds) {
  const auto space = std::make_shared<MapSpace>(regionOf(false)->parts().map->grid());
  space->setup();
  RegionSampler one(space.get(), regionOf(false), 5), same(space.get(), regionOf(false), 5),
      other(space.get(), regionOf(false), 6);
  ob::ScopedState<MapSpace> a(space), b(space), c(space), corner(space);
  MapSpace::setPlace(corner.get(), {0.5, 0.5});
  int differ = 0;
  double spread_m2 = 0.0;
  for (int k = 0; k < 2'000; ++k) {
    one.sampleUniform(a.get());
    same.sampleUniform(b.get());
    other.sampleUniform(c.get());
    EXPECT_EQ(MapSpace::place(a.get()), MapSpace::place(b.get()));
    differ += !(MapSpace::place(a.get()) == MapSpace::place(c.get()));
    one.sampleUniformNear(a.get(), corner.get(), 3.0);
    same.sampleUniformNear(b.get(), corner.get(), 3.0);
    EXPECT_TRUE(space->satisfiesBounds(a.get()));
    EXPECT_LE(std::abs(MapSpace::place(a.get()).x_m - 0.5), 3.0);
    EXPECT_LE(std::abs(MapSpace::place(a.get()).y_m - 0.5), 3.0);
    MapSpace::setPlace(c.get(), {20.0, 15.0});
    one.sampleGaussian(a.get(), c.get(), 2.0);
    same.sampleGaussian(b.get(), c.get(), 2.0);
    const maps::Point drawn = MapSpace::place(a.get());
    spread_m2 += std::pow(drawn.x_m - 20.0, 2) + std::pow(drawn.y_m - 15.0, 2);
  }
  EXPECT_GT(differ, 1'990);
  // Closed form: two variances of 4 m2; the mean of 2000 has a standard deviation of 8 / sqrt(2000) = 0.18.
  EXPECT_NEAR(spread_m2 / 2'000, 8.0, 5 * 0.18);
}

// Closed form: at 10 J/m the heuristic of a state is ten times the length over both foci.
TEST(RegionSampler, InformedSamplesLieBetweenTheRequestedCosts) {
  const auto region = regionOf(false);
  const testing::OmplGround ground(region->parts().map, {{10.5, 15.5}, {30.5, 15.5}});
  RegionInformedSampler sampler(
      {.problem = ground.definition, .max_calls = 100, .region = region, .seed = 2});
  ob::ScopedState<MapSpace> state(ground.space->getStateSpace());
  int between = 0;
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(sampler.sampleUniform(state.get(), ob::Cost(230.0)));
    const maps::Point p = MapSpace::place(state.get());
    const double way_m = std::hypot(p.x_m - 10.5, p.y_m - 15.5) + std::hypot(p.x_m - 30.5, p.y_m - 15.5);
    EXPECT_LE(way_m, 23.0 + 1e-9);
    EXPECT_NEAR(sampler.heuristicSolnCost(state.get()).value(), 10.0 * way_m, 1e-4);
    if (!sampler.sampleUniform(state.get(), ob::Cost(210.0), ob::Cost(230.0))) continue;
    ++between;
    EXPECT_GE(sampler.heuristicSolnCost(state.get()).value(), 210.0);
  }
  EXPECT_GT(between, 100);
  EXPECT_FALSE(sampler.sampleUniform(state.get(), ob::Cost(199.0)));
}

// Closed form: uphill at 205/1024 (drawn_map.hpp) a metre costs 100 g more than downhill; between nodes a
// parabola of 400 is off by 400 / 4 / 256^2. A blocked motion has the maximum cost.
TEST(TravelObjective, CostDependsOnDirectionAndBlockedMotionIsMaximal) {
  const testing::OmplGround ramp(testing::drawn({">>>>#", ">>>>#"}), {{0.5, 0.5}, {3.5, 0.5}});
  const auto low = ramp.at({0.5, 0.5}), high = ramp.at({2.5, 0.5}), wall = ramp.at({4.5, 0.5});
  const double g = 205.0 / 1024, down_J = 2 * (10 + 400 * g * g);
  EXPECT_NEAR(ramp.objective->motionCost(low.get(), high.get()).value(), down_J + 200 * g, 0.0032);
  EXPECT_NEAR(ramp.objective->motionCost(high.get(), low.get()).value(), down_J, 0.0032);
  EXPECT_EQ(ramp.objective->motionCost(low.get(), wall.get()).value(), kBlockedMotionCost_J);
  EXPECT_FALSE(ramp.objective->isSymmetric());
  EXPECT_EQ(ramp.objective->stateCost(low.get()).value(), 0.0);
}

// Property: the heuristics are admissible, and every sum of allowed motions is below the cost of a blocked
// motion.
TEST(TravelObjective, HeuristicsAreAdmissible) {
  const Segment ends{{1.5, 1.5}, {17.5, 16.5}};
  const testing::OmplGround on(testing::randomMap({.seed = 6, .blocked = 0.05, .roughness = 0.2}), ends);
  const auto goal = on.at(ends.to), start = on.at(ends.from);
  int tried = 0;
  for (int k = 0; k < 400; ++k) {
    const auto from = on.at({0.5 + k % 20, 0.5 + k / 20}),
               to = on.at({0.5 + (k * 7 + 3) % 20, 0.5 + (k * 3) % 20});
    for (const auto& [a, b] : {std::pair{&from, &to}, {&from, &goal}, {&start, &to}}) {
      const double exact_J = on.objective->motionCost(a->get(), b->get()).value();
      EXPECT_LE(on.objective->motionCostHeuristic(a->get(), b->get()).value(), exact_J * (1 + 1e-9));
      EXPECT_LE(exact_J, kBlockedMotionCost_J);
      tried += exact_J < kBlockedMotionCost_J;
    }
    EXPECT_LE(on.objective->costToGo(from.get(), nullptr).value(),
              on.objective->motionCost(from.get(), goal.get()).value() * (1 + 1e-9));
  }
  EXPECT_GT(tried, 100);
}

}  // namespace travel_objective_test

}  // namespace talus::planner
