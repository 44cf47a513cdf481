#include <cmath>
#include <numbers>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/pose/pose_shortcut.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_shortcut_test {

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
      const PoseCost cost(motion, {.turning_radius_m = 2.0, .may_reverse = reverse, .cusp = {.cost_J = 3.0}});
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
