#include <cmath>
#include <string>

#include <talus/common/common.hpp>
#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace slip_world_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SlipWorld, SlipMatchesThePublishedCurve) {
  const SlipTerrain terrain{.gain_deg2 = 4e-3, .offset = 0.05, .noise = 0.05};
  // Closed form: 0.05 +- 4e-3 10^2.
  EXPECT_NEAR(terrain.slip(std::tan(10.0 * kDegree)), 0.45, 1e-12);
  EXPECT_NEAR(terrain.slip(-std::tan(10.0 * kDegree)), -0.35, 1e-12);
  EXPECT_NEAR(terrain.slip(0.0), 0.05, 1e-12);
}

TEST(SlipWorld, TerrainSharesMatchTheOptions) {
  const SlipWorld world = slipWorld({.seed = 5, .misclassification_rate = 0.2});
  std::array<int, 10> count{};
  int misclassification_rate = 0;
  for (std::size_t i = 0; i < world.truth.values().size(); ++i) {
    ++count[world.truth.values()[i]];
    misclassification_rate += world.truth.values()[i] != world.seen.values()[i];
  }
  std::ranges::sort(count, std::greater<>{});
  const double cells = 96.0 * 96.0;
  EXPECT_NEAR(count[0] / cells, 0.4, 1e-3);
  EXPECT_NEAR(count[1] / cells, 0.4, 1e-3);
  EXPECT_NEAR(count[3] / cells, 0.1, 1e-3);
  EXPECT_EQ(count[4], 0);
  EXPECT_NEAR(misclassification_rate / cells, 0.2, 1e-3);
}

// Property: without uncertainty and relief the cost is the time at the slip on level ground, and a drive
// without slip errors takes the same time.
TEST(SlipWorld, CostOnLevelGroundIsTheTravelTime) {
  SlipWorld world =
      slipWorld({.seed = 3, .misclassification_rate = 0.0, .relief_m = 0.0, .risk_aware = false});
  for (float& error : world.error.values()) error = 0.0F;
  const std::vector<maps::Point> route{{5.5, 5.5}, {80.5, 60.5}, {20.5, 90.5}};
  const SlipTraverse drive = driven(world, route);
  EXPECT_TRUE(drive.reached);
  EXPECT_LE(drive.max_slip, 0.1);
  // At each change of terrain a tenth of a cell may be priced as the other terrain.
  EXPECT_NEAR(MotionCost(world.map).along(route), drive.time_s, 2e-3 * drive.time_s);
}

// Closed form: the mean of a Gaussian beyond its upper decile is 1.755 standard deviations above its mean.
TEST(SlipWorld, RiskAwareCostIsTheTailOfTheMixture) {
  const SlipWorld world =
      slipWorld({.seed = 3, .misclassification_rate = 0.0, .relief_m = 0.0, .risk_aware = true, .tail = 0.1});
  const maps::Cell cell{10, 10};
  const SlipTerrain& terrain = world.terrains[world.truth[cell]];
  const double slip = terrain.offset + 1.7550 * terrain.noise;
  EXPECT_NEAR(static_cast<double>(world.map->cost().costPerMetre(world.map->at(cell), {1.0, 0.0})),
              10.0 / (1.0 - slip), 2e-3);
}

TEST(SlipWorld, RoverStopsAtSlipOne) {
  SlipWorld world = slipWorld({.seed = 2, .relief_m = 0.0});
  for (float& error : world.error.values()) error = 0.0F;
  world.error[{50, 20}] = 2.0F;
  const SlipTraverse stuck = driven(world, {{10.5, 20.5}, {90.5, 20.5}});
  EXPECT_FALSE(stuck.reached);
  EXPECT_EQ(stuck.max_slip, 1.0);
  EXPECT_NEAR(stuck.time_s, 40.0 / 0.1, 0.15 * 400.0);  // the rover travelled 40 m at slips of 0 to 0.1
  EXPECT_TRUE(driven(world, {{10.5, 21.5}, {90.5, 21.5}}).reached);
}

// Property (stated by the paper): risk-aware planning reaches more goals than planning on the mean slip.
TEST(SlipWorld, RiskAwarePlanningReachesMoreGoals) {
  int blind = 0, heedful = 0, asked = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto reached = [&](bool heed) {
      const SlipWorld world = slipWorld({.seed = seed, .risk_aware = heed});
      Problem problem;
      problem.map = world.map;
      problem.start = {8.5, 8.5};
      problem.goal = {87.5, 87.5};
      problem.prove = false;
      const Plan plan = FieldPlanner().plan(problem);
      if (plan.status != RouteStatus::Found) return -1;
      EXPECT_TRUE(violations(*world.map, plan.points).empty());
      return static_cast<int>(driven(world, plan.points).reached);
    };
    const int mean = reached(false), tail = reached(true);
    if (mean < 0 || tail < 0) continue;
    ++asked;
    blind += mean;
    heedful += tail;
  }
  EXPECT_GE(asked, 15);
  EXPECT_GT(heedful, blind);
  RecordProperty("asked", asked);
  RecordProperty("blind", blind);
  RecordProperty("heedful", heedful);
}

TEST(SlipWorld, SameSeedReproducesTheWorld) {
  const SlipWorld a = slipWorld({.seed = 7}), b = slipWorld({.seed = 7}), c = slipWorld({.seed = 8});
  EXPECT_EQ(a.truth.values(), b.truth.values());
  EXPECT_EQ(a.error.values(), b.error.values());
  EXPECT_NE(a.truth.values(), c.truth.values());
}

TEST(SlipWorld, OptionsOutOfRangeAreRejected) {
  EXPECT_THAT([] { slipWorld({.side = 4}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("side = 4")));
  EXPECT_THAT([] { slipWorld({.misclassification_rate = 1.5}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("misclassification_rate")));
  EXPECT_THAT([] { slipWorld({.relief_m = -1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("relief")));
  EXPECT_THAT([] { slipWorld({.tail = 0.0}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("tail")));
}

}  // namespace slip_world_test
}  // namespace talus::planner
