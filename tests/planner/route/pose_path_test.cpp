#include <cmath>
#include <limits>
#include <numbers>

#include <talus/planner/route/pose_path.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_path_test {

using testing::drawn;

TEST(PosePath, StraightLegCostEqualsMotionCost) {
  const MotionCost motion(drawn({"0123", "0123"}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0});
  EXPECT_DOUBLE_EQ(cost({{0.5, 0.5}, 0.0}, {{3.0, 0.0}, 0.0}), motion({{0.5, 0.5}, {3.5, 0.5}}));
}

TEST(PosePath, ReverseCostEqualsDrivingInThatDirection) {
  const MotionCost motion(drawn({">>>>"}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0});
  // A rover that faces east and reverses west goes downhill.
  EXPECT_DOUBLE_EQ(cost({{3.5, 0.5}, 0.0}, {{-3.0, 0.0}, 0.0}), motion({{3.5, 0.5}, {0.5, 0.5}}));
}

TEST(PosePath, ArcCostOnUniformGroundIsLengthPlusTurn) {
  const MotionCost motion(drawn({"....", "....", "....", "...."}));
  const PoseCost cost(motion,
                      {.turning_radius_m = 2.0, .turns = {.on_arc = {.cost_J = 7.0}, .in_place = {}}});
  // Closed form: 10 J/m; chords of 0.1 rad are shorter than their arc by 0.1^2/24.
  EXPECT_NEAR(cost({{0.5, 0.5}, 0.0}, {{std::numbers::pi, 0.5}, 0.0}),
              10.0 * std::numbers::pi + 7.0 * std::numbers::pi / 2, 10.0 * std::numbers::pi * 5e-4);
}

TEST(PosePath, TurnInPlaceRequiresEveryHeading) {
  // The steep cell may be crossed east and west at 0.2; a cross limit of 0.1 forbids the heading north.
  const auto steep = testing::drawn({">"});
  const costmap::CostGrid grid({.grid = steep->grid(),
                                .tiles = steep->content().tiles,
                                .cost = testing::driveCost({.max_along = 0.3, .max_across = 0.1}),
                                .version = 1});
  const MotionCost motion(std::make_shared<const costmap::CostGrid>(grid));
  const PoseCost cost(motion, {.turns = {.on_arc = {}, .in_place = {.cost_J = 3.0}}});
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, 0.0}, {{}, std::numbers::pi / 2})));
  EXPECT_DOUBLE_EQ(cost({{0.5, 0.5}, 0.0}, {{}, 0.2}), 0.6);
}

TEST(PosePath, CuspsAreCountedAndPriced) {
  const MotionCost motion(drawn({"....."}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0, .cusp = {.cost_J = 5.0}});
  const PosePath path{.start = {{1.5, 0.5}, 0.0}, .legs = {{{2.0, 0.0}, 0.0}, {{-1.0, 0.0}, 0.0}}};
  EXPECT_EQ(shape(path).cusps, 1);
  EXPECT_NEAR(cost(path), 35.0, 1e-6);
}

TEST(PosePath, SamplesEndAtTheDriveEnd) {
  const PosePath path{.start = {{0.0, 0.0}, 0.0},
                      .legs = {{{std::numbers::pi, 0.5}, 0.0}, {{}, 1.0}, {{1.0, 0.0}, 0.0}}};
  const auto poses = sampled(path, 0.1);
  Pose end = path.start;
  for (const auto& leg : path.legs) end = after(end, leg);
  EXPECT_NEAR(poses.back().place.x_m, end.place.x_m, 1e-9);
  EXPECT_NEAR(poses.back().heading_rad, end.heading_rad, 1e-9);
  for (std::size_t k = 1; k < poses.size(); ++k)
    EXPECT_LE(
        std::hypot(poses[k].place.x_m - poses[k - 1].place.x_m, poses[k].place.y_m - poses[k - 1].place.y_m),
        0.1 + 1e-9);
}

}  // namespace pose_path_test
}  // namespace talus::planner
