#include <cmath>
#include <numbers>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/pose/pose_shortcut.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_shortcut_test {

std::shared_ptr<const costmap::CostGrid> plain() {
  return testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
}

TEST(TurningDrive, SmallHeadingChangesYieldNoStop) {
  const MotionCost motion(plain());
  const std::vector<maps::Point> wiggle{{1.5, 1.5}, {3.5, 1.7}, {5.5, 1.4}, {7.5, 1.6}, {9.5, 1.5}};
  const PoseCost dear(motion, {.turns = {.on_arc = {}, .in_place = {.energy_J = 1.0}, .at_vertex = {}},
                               .stop = {.energy_J = 20.0}});
  const PosePath straight = turningPath(wiggle, {}, dear);
  EXPECT_EQ(shape(straight).turns_in_place, 0);
  EXPECT_NEAR(dear(straight), 80.0, 1e-9);  // Closed form: 8 m at 10 J/m
}

TEST(TurningDrive, TurnsInPlaceOnlyWhereRequired) {
  auto rows = std::vector<std::string>(20, std::string(20, '.'));
  for (std::size_t r = 8; r < 19; ++r) rows[r][10] = '#';  // a wall from the south to the last row but one
  const MotionCost motion(testing::drawn(rows));
  const PoseCost cost(motion, {.turns = {.on_arc = {}, .in_place = {.energy_J = 1.0}, .at_vertex = {}},
                               .stop = {.energy_J = 20.0}});
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
  Kinematics kinematics{.turns = {.on_arc = {}, .in_place = {.energy_J = 30.0}, .at_vertex = {}}};
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

using testing::drawn;
using testing::randomMap;

Pose end(const PosePath& path) {
  Pose pose = path.start;
  for (const auto& leg : path.legs) pose = after(pose, leg);
  return pose;
}

// A drive that weaves about the x axis in arcs of the smallest radius, as the short motions of a search do.
PosePath weaving(int bends) {
  PosePath path{.start = {{3.0, 10.0}, 0.4}, .legs = {}};
  for (int k = 0; k < bends; ++k)
    for (int part = 0; part < 4; ++part) path.legs.push_back({{0.4, (k % 2 ? 0.5 : -0.5)}, 0.0});
  return path;
}

// Closed form: on level ground of 10 J/m the straight line between the ends is optimal, and a weave of small
// headings is shortened to within 1 % of it.
TEST(PoseShortcut, WeavingDriveOnFlatGroundIsStraightened) {
  const auto map = drawn(std::vector<std::string>(20, std::string(40, '.')));
  const MotionCost motion(map);
  const PoseCost cost(motion, {.turning_radius_m = 2.0});
  const PosePath weave = weaving(16);
  const PosePath made = shortened(weave, cost, {.joint_m = 4.0, .cheapest_J_per_m = 10.0});
  const Pose a = weave.start, b = end(weave);
  const double straight_J = 10.0 * std::hypot(b.place.x_m - a.place.x_m, b.place.y_m - a.place.y_m);
  EXPECT_GE(cost(made), straight_J);
  EXPECT_LE(cost(made), 1.01 * straight_J);
  EXPECT_GT(cost(weave), 1.02 * straight_J);
}

// Property: on random ground, with and without reversing, the result has the ends of the drive, costs no
// more, and keeps the radius.
TEST(PoseShortcut, EndsAreKeptAndCostNeverIncreases) {
  int cheaper = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const bool reverse : {true, false}) {
      const auto map =
          randomMap({.width = 40, .height = 20, .seed = seed, .blocked = 0.0, .roughness = 0.15});
      const MotionCost motion(map);
      const PoseCost cost(motion,
                          {.turning_radius_m = 2.0, .may_reverse = reverse, .cusp = {.energy_J = 3.0}});
      PosePath drive = weaving(12);
      if (reverse) drive.legs.insert(drive.legs.begin() + 9, {{{-1.5, 0.0}, 0.0}, {{1.5, 0.0}, 0.0}});
      const PosePath made = shortened(drive, cost, {.joint_m = 3.0, .cheapest_J_per_m = 1.0});
      EXPECT_LE(cost(made), cost(drive)) << seed;
      EXPECT_NEAR(end(made).place.x_m, end(drive).place.x_m, 1e-6);
      EXPECT_NEAR(end(made).place.y_m, end(drive).place.y_m, 1e-6);
      EXPECT_NEAR(std::remainder(end(made).heading_rad - end(drive).heading_rad, 2 * std::numbers::pi), 0.0,
                  1e-6);
      EXPECT_LE(shape(made).max_curvature_1_m, 0.5 + 1e-9);
      if (!reverse) {
        EXPECT_EQ(shape(made).cusps, 0) << seed;
      }
      cheaper += cost(made) < cost(drive);
    }
  EXPECT_GT(cheaper, 30);
}

}  // namespace pose_shortcut_test
}  // namespace talus::planner
