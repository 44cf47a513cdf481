#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>

#include <talus/planner/route/dubins.hpp>

namespace talus::planner {
namespace dubins_test {

Pose end(Pose pose, const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) pose = after(pose, arc);
  return pose;
}

double length_m(const std::vector<Arc>& arcs) {
  double sum = 0.0;
  for (const Arc& arc : arcs) sum += arc.length_m;
  return sum;
}

struct Between {
  Pose from, to;
};

Between drawn(std::mt19937_64& random, double reach_m) {
  std::uniform_real_distribution<double> place(-reach_m, reach_m), heading(-7.0, 7.0);
  return {{{place(random), place(random)}, heading(random)},
          {{place(random), place(random)}, heading(random)}};
}

TEST(Dubins, CurvesReachTheTargetWithoutReversing) {
  // Property: for random poses from a third of a radius to thousands of radii apart the arcs end at the
  // target.
  std::mt19937_64 random(1);
  for (const double reach_m : {0.5, 3.0, 50.0, 5000.0})
    for (int k = 0; k < 2000; ++k) {
      const Between b = drawn(random, reach_m);
      const auto arcs = shortestForward(b.from, b.to, 1.5);
      const Pose last = end(b.from, arcs);
      EXPECT_NEAR(last.place.x_m, b.to.place.x_m, 1e-8 * reach_m + 1e-8);
      EXPECT_NEAR(last.place.y_m, b.to.place.y_m, 1e-8 * reach_m + 1e-8);
      EXPECT_NEAR(std::remainder(last.heading_rad - b.to.heading_rad, 2 * std::numbers::pi), 0.0, 1e-8);
      for (const Arc& arc : arcs) {
        EXPECT_GT(arc.length_m, 0.0);
        EXPECT_LE(std::abs(arc.curvature_1_m), 1.0 / 1.5 + 1e-12);
      }
    }
}

TEST(Dubins, LengthMatchesOmpl) {
  // Closed form: OMPL's independent implementation, on paths short enough for its own bounds.
  const auto space = std::make_shared<ompl::base::DubinsStateSpace>(1.5);
  ompl::base::ScopedState<ompl::base::DubinsStateSpace> a(space), b(space);
  std::mt19937_64 random(2);
  for (int k = 0; k < 3000; ++k) {
    const Between ends = drawn(random, k % 2 ? 3.0 : 8.0);
    a->setXY(ends.from.place.x_m, ends.from.place.y_m);
    a->setYaw(std::remainder(ends.from.heading_rad, 2 * std::numbers::pi));
    b->setXY(ends.to.place.x_m, ends.to.place.y_m);
    b->setYaw(std::remainder(ends.to.heading_rad, 2 * std::numbers::pi));
    EXPECT_NEAR(length_m(shortestForward(ends.from, ends.to, 1.5)), space->distance(a.get(), b.get()), 1e-5);
  }
}

TEST(Dubins, StraightTargetYieldsOneArc) {
  // Closed form: a target 100 km straight ahead; rounding of the heading must not add a circle.
  const double heading = 0.3;
  const Pose to{{1e5 * std::cos(heading), 1e5 * std::sin(heading)}, heading};
  EXPECT_NEAR(length_m(shortestForward({{0.0, 0.0}, heading}, to, 1.0)), 1e5, 1e-3);
}

}  // namespace dubins_test
}  // namespace talus::planner
