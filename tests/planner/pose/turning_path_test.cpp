#include <cmath>
#include <numbers>

#include <talus/planner/pose/turning_path.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace turning_path_test {

std::shared_ptr<const costmap::CostGrid> plain() {
  return testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
}

TEST(TurningDrive, SmallHeadingChangesYieldNoStop) {
  const MotionCost motion(plain());
  const std::vector<maps::Point> wiggle{{1.5, 1.5}, {3.5, 1.7}, {5.5, 1.4}, {7.5, 1.6}, {9.5, 1.5}};
  const PoseCost dear(motion,
                      {.turns = {.on_arc = {}, .in_place = {.cost_J = 1.0}}, .stop = {.cost_J = 20.0}});
  const PosePath straight = turningPath(wiggle, {}, dear);
  EXPECT_EQ(shape(straight).turns_in_place, 0);
  EXPECT_NEAR(dear(straight), 80.0, 1e-9);  // Closed form: 8 m at 10 J/m
}

TEST(TurningDrive, TurnsInPlaceOnlyWhereRequired) {
  auto rows = std::vector<std::string>(20, std::string(20, '.'));
  for (std::size_t r = 8; r < 19; ++r) rows[r][10] = '#';  // a wall from the south to the last row but one
  const MotionCost motion(testing::drawn(rows));
  const PoseCost cost(motion,
                      {.turns = {.on_arc = {}, .in_place = {.cost_J = 1.0}}, .stop = {.cost_J = 20.0}});
  const std::vector<maps::Point> around{{5.5, 5.5},   {8.0, 9.5},  {9.0, 12.5},
                                        {12.0, 12.5}, {13.0, 9.5}, {15.5, 5.5}};
  const PosePath drive = turningPath(around, {.start_rad = 0.0, .goal_rad = 0.0}, cost);
  ASSERT_FALSE(drive.legs.empty());
  EXPECT_TRUE(std::isfinite(cost(drive)));
  EXPECT_GE(shape(drive).turns_in_place, 3);
  Pose end = drive.start;
  for (const auto& leg : drive.legs) end = after(end, leg);
  EXPECT_NEAR(end.place.x_m, 15.5, 1e-9);
  EXPECT_NEAR(std::remainder(end.heading_rad, 2 * std::numbers::pi), 0.0, 1e-9);
}

TEST(TurningDrive, ReversesIfTurningIsCostlier) {
  const MotionCost motion(plain());
  Kinematics kinematics{.turns = {.on_arc = {}, .in_place = {.cost_J = 30.0}}};
  const std::vector<maps::Point> west{{10.5, 5.5}, {5.5, 5.5}};
  const PosePath backed = turningPath(west, {.start_rad = 0.0, .goal_rad = {}}, PoseCost(motion, kinematics));
  EXPECT_LT(backed.legs.front().arc.length_m, 0.0);
  kinematics.may_reverse = false;
  const PosePath turned = turningPath(west, {.start_rad = 0.0, .goal_rad = {}}, PoseCost(motion, kinematics));
  EXPECT_NEAR(std::abs(turned.legs.front().turn_rad), std::numbers::pi, 1e-9);
}

TEST(TurningDrive, BlockedRouteYieldsNoDrive) {
  const MotionCost motion(testing::drawn({".#."}));
  EXPECT_TRUE(turningPath({{0.5, 0.5}, {2.5, 0.5}}, {}, PoseCost(motion, {})).legs.empty());
}

}  // namespace turning_path_test
}  // namespace talus::planner
