#include <cmath>

#include <ompl/base/ScopedState.h>

#include <talus/planner/sampling/travel_objective.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
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
