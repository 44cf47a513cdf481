#include <cmath>
#include <numbers>

#include <talus/planner/pose/motion_set.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace motion_set_test {

using testing::drawn;
using testing::randomMap;

constexpr MotionSet::Options kOptions{.headings = 72, .step_cells = 1.5, .offset_rad = 0.3};

// Property: the stated end of a motion is the end of its leg, in one of the set's headings; arcs keep the
// radius, and without reversing no motion goes backwards.
TEST(MotionSet, StatedMotionEndsMatchTheirLegs) {
  const auto map = drawn({".....", "....."});
  for (const double radius_m : {0.0, 0.7, 4.0})
    for (const bool reverse : {true, false}) {
      const MotionSet set(*map, {.turning_radius_m = radius_m, .may_reverse = reverse}, kOptions);
      int backwards = 0, turns = 0;
      for (int k = 0; k < set.headings(); ++k)
        for (const MotionSet::Motion& motion : set.from(k)) {
          const Pose end = after(Pose{{0.0, 0.0}, set.heading_rad(k)}, motion.leg);
          EXPECT_NEAR(end.place.x_m, motion.dx_m, 1e-12);
          EXPECT_NEAR(end.place.y_m, motion.dy_m, 1e-12);
          EXPECT_NEAR(std::remainder(end.heading_rad - set.heading_rad(motion.heading), 2 * std::numbers::pi),
                      0.0, 1e-9);
          if (radius_m > 0.0) {
            EXPECT_LE(std::abs(motion.leg.arc.curvature_1_m), 1 / radius_m + 1e-12);
            EXPECT_EQ(motion.leg.turn_rad, 0.0);
          }
          EXPECT_EQ(motion.direction, direction(motion.leg));
          backwards += motion.direction < 0;
          turns += motion.direction == 0;
        }
      EXPECT_EQ(backwards > 0, reverse);
      EXPECT_EQ(turns > 0, radius_m == 0.0);
    }
}

// Closed form: arcs of 200 times the radius are 200 times as long.
TEST(MotionSet, WorkIsProportionalToMotionLength) {
  const auto map = drawn({".....", "....."});
  const auto work = [&](double radius_m) {
    return MotionSet(*map, {.turning_radius_m = radius_m}, kOptions).work();
  };
  EXPECT_EQ(work(4.0), 1U);
  EXPECT_NEAR(static_cast<double>(work(4000.0)) / static_cast<double>(work(400.0)), 10.0, 1.0);
}

// Closed form: on uniform ground of 10 J/m the cost of a motion is that of its length and of its turn in
// place or on the arc.
TEST(MotionSet, MotionCostOnUniformGroundIsLengthPlusTurn) {
  const auto map = drawn(std::vector<std::string>(9, std::string(9, '.')));
  for (const double radius_m : {0.0, 1.5}) {
    const Kinematics kinematics{.turning_radius_m = radius_m,
                                .turns = {.on_arc = {.cost_J = 3.0}, .in_place = {.cost_J = 7.0}},
                                .stop = {.cost_J = 11.0}};
    const MotionSet set(*map, kinematics, kOptions);
    for (const MotionSet::Motion& motion : set.from(5)) {
      double expected_J = 10.0 * std::abs(motion.leg.arc.length_m);
      if (motion.direction == 0)
        expected_J = 11.0 + 7.0 * std::abs(motion.leg.turn_rad);
      else
        expected_J += 3.0 * std::abs(motion.leg.arc.length_m * motion.leg.arc.curvature_1_m);
      EXPECT_NEAR(set.quickCost(motion, {4.5, 4.5}), expected_J, 1e-6);
    }
  }
}

// Closed form: on a ramp that rises eastwards at 205/1024 (drawn_map.hpp), forward is uphill and reverse
// downhill. Between the nodes of the curve a parabola of 400 is off by 400 / 4 / 256^2.
TEST(MotionSet, ReverseCostEqualsDrivingInThatDirection) {
  const auto map = drawn(std::vector<std::string>(9, std::string(9, '>')));
  const MotionSet set(*map, {}, {.headings = 72, .step_cells = 1.5, .offset_rad = 0.0});
  const double g = 205.0 / 1024.0, back_J = 10 + 400 * g * g;
  for (const MotionSet::Motion& motion : set.from(0)) {
    if (motion.direction == 0) continue;
    const double metre_J = motion.direction > 0 ? back_J + 100 * g : back_J;
    EXPECT_NEAR(set.quickCost(motion, {4.5, 4.5}), 1.5 * metre_J, 1.5 * 0.0016);
  }
}

// Property: the quick cost is infinite off the map and over blocked ground. On rough ground it is close to
// the exact cost; it is sampled at intervals of half a cell.
TEST(MotionSet, QuickCostApproximatesTheExactCost) {
  const auto map = randomMap({.width = 30, .height = 30, .seed = 5, .blocked = 0.1, .roughness = 0.15});
  const MotionCost motion_cost(map);
  const Kinematics kinematics{.turning_radius_m = 2.0};
  const PoseCost exact(motion_cost, kinematics);
  const MotionSet set(*map, kinematics, kOptions);
  double quick_sum = 0.0, exact_sum = 0.0;
  int refused = 0;
  for (int n = 0; n < 200; ++n) {
    const maps::Point from{5.2 + n % 20, 4.7 + n / 10};
    for (const MotionSet::Motion& motion : set.from(n % 72)) {
      const double quick_J = set.quickCost(motion, from),
                   exact_J = exact({from, set.heading_rad(n % 72)}, motion.leg);
      refused += std::isinf(quick_J);
      if (!std::isfinite(exact_J)) continue;
      ASSERT_TRUE(std::isfinite(quick_J));  // every sampled cell is crossed by the exact motion
      quick_sum += quick_J;
      exact_sum += exact_J;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_NEAR(quick_sum, exact_sum, 0.02 * exact_sum);
  // Closed form: half a cell from the western edge, every longer motion westwards leaves the map.
  const MotionSet straight(*map, kinematics, {.headings = 72, .step_cells = 1.5, .offset_rad = 0.0});
  for (const MotionSet::Motion& motion : straight.from(0))
    if (motion.dx_m < -0.9) {
      EXPECT_TRUE(std::isinf(straight.quickCost(motion, {0.5, 15.5})));
    }
}

}  // namespace motion_set_test
}  // namespace talus::planner
