#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/planner/route/route.hpp>

namespace talus::planner {

namespace route_test {

// Property: the end of an arc equals the integral of its heading by the midpoint rule (error of n steps
// below (length curvature)^2 length / (24 n^2)); the reversed arc returns to the start.
TEST(Arc, EndIsTheIntegralOfTheHeading) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    const Pose from{{5 * unit(random), 5 * unit(random)}, 3 * unit(random)};
    // The sample includes nearly straight arcs and zero curvature.
    const Arc arc{4 * unit(random), k % 5 == 0 ? 0.0 : unit(random) * std::pow(10.0, -(k % 12))};
    constexpr int kSteps = 4'000;
    Pose walked = from;
    for (int n = 0; n < kSteps; ++n) {
      const double middle = from.heading_rad + arc.length_m * arc.curvature_1_m * (n + 0.5) / kSteps;
      walked.place.x_m += arc.length_m / kSteps * std::cos(middle);
      walked.place.y_m += arc.length_m / kSteps * std::sin(middle);
    }
    const Pose end = after(from, arc);
    EXPECT_NEAR(end.place.x_m, walked.place.x_m, 1e-6) << arc.curvature_1_m;
    EXPECT_NEAR(end.place.y_m, walked.place.y_m, 1e-6) << arc.curvature_1_m;
    const Pose back = after(end, Arc{-arc.length_m, arc.curvature_1_m});
    EXPECT_NEAR(back.place.x_m, from.place.x_m, 1e-9);
    EXPECT_NEAR(back.place.y_m, from.place.y_m, 1e-9);
    EXPECT_NEAR(back.heading_rad, from.heading_rad, 1e-12);
  }
}

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

TEST(Kinematics, ShortestCurvesReachTheTargetAndKeepTheRadius) {
  // Property: for random poses both families of curves end at the target, and reversing never makes the path
  // longer.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-5.0, 5.0), heading(-4.0, 4.0);
  for (int k = 0; k < 500; ++k) {
    const Pose from{{place(random), place(random)}, heading(random)},
        to{{place(random), place(random)}, heading(random)};
    double length[2] = {0.0, 0.0};
    for (const bool reverse : {false, true}) {
      const auto arcs = ShortestCurves({.turning_radius_m = 1.5, .may_reverse = reverse})(from, to);
      const Pose reached = end(from, arcs);
      EXPECT_NEAR(reached.place.x_m, to.place.x_m, 1e-6);
      EXPECT_NEAR(reached.place.y_m, to.place.y_m, 1e-6);
      EXPECT_NEAR(std::remainder(reached.heading_rad - to.heading_rad, 2 * std::numbers::pi), 0.0, 1e-6);
      for (const Arc& arc : arcs) {
        EXPECT_LE(std::abs(arc.curvature_1_m), 1.0 / 1.5 + 1e-12);
        if (!reverse) {
          EXPECT_GT(arc.length_m, 0.0);
        }
        length[reverse ? 1 : 0] += std::abs(arc.length_m);
      }
    }
    EXPECT_LE(length[1], length[0] + 1e-9);
  }
}

// Below a radius of a millimetre OMPL's Reeds-Shepp curves do not reach the target, and an assertion ends
// the process.
TEST(Kinematics, TurningRadiusHasALowerBound) {
  const Pose from{{0.0, 0.0}, 0.3};
  for (const double bad : {0.0, 1e-15, 1e-9, 1e-4, 2000.0, std::nan("")})
    EXPECT_THROW(ShortestCurves({.turning_radius_m = bad}), std::invalid_argument) << bad;
  // Property: with the smallest radius a path across the longest map ends at its target.
  const Pose far{{130000.0, 900.0}, 2.0};
  for (const bool reverse : {false, true}) {
    const Pose reached =
        end(from, ShortestCurves({.turning_radius_m = 1e-3, .may_reverse = reverse})(from, far));
    EXPECT_NEAR(reached.place.x_m, far.place.x_m, 1e-2);
    EXPECT_NEAR(reached.place.y_m, far.place.y_m, 1e-2);
  }
}

TEST(Kinematics, TurnEffortsComeFromTheMapCost) {
  const auto model = costmap::testGround();
  const costmap::TravelCost cost(model->limits(),
                                 std::vector<costmap::GroundCost>{model->ground(0, model->prior(0))});
  const Kinematics made = kinematicsOn(*model, cost);
  ASSERT_EQ(made.turns_by_curve.size(), 1U);
  EXPECT_GT(made.turnsOn(0).in_place.energy_J, 0.0);
  EXPECT_EQ(made.turnsOn(0).at_vertex.energy_J, cost.turn(costmap::CellCode({0.0, 0.0, 0})).energy_J);
}

TEST(Kinematics, AckermannSteeringRequiresATurningRadius) {
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  const costmap::TravelCost cost({}, std::vector<costmap::TravelCurve>{});
  parts.rover.steering = terramech::Steering::Ackermann;
  parts.rover.turning_radius_m = 0.0;
  EXPECT_REFUSED(kinematicsOn(costmap::GroundModel(parts), cost), std::invalid_argument,
                 "turning_radius_m = 0, must be > 0 with steering ackermann");
}

// The names are part of the documented output format.
TEST(Route, StatusNamesMatchTheFileFormat) {
  const std::pair<RouteStatus, const char*> promised[] = {{RouteStatus::Found, "found"},
                                                          {RouteStatus::NoRoute, "no_route"},
                                                          {RouteStatus::NoneFound, "none_found"},
                                                          {RouteStatus::StartInvalid, "start_invalid"},
                                                          {RouteStatus::GoalInvalid, "goal_invalid"},
                                                          {RouteStatus::TimedOut, "timed_out"},
                                                          {RouteStatus::Cancelled, "cancelled"}};
  for (const auto& [status, word] : promised) EXPECT_EQ(name(status), word);
}

}  // namespace route_test

}  // namespace talus::planner
