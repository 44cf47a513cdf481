#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/planner/route/kinematics.hpp>

namespace talus::planner {
namespace kinematics_test {

Pose end(Pose pose, const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) pose = after(pose, arc);
  return pose;
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

TEST(Kinematics, TurnCostsComeFromTheMapCost) {
  const auto model = costmap::testGround();
  const costmap::TravelCost cost(model->limits(),
                                 std::vector<costmap::GroundCost>{model->ground(0, model->prior(0))});
  const Kinematics made = kinematicsOn(*model, cost);
  ASSERT_EQ(made.turns_by_curve.size(), 1U);
  EXPECT_GT(made.turnsOn(0).in_place.energy_J, 0.0);
  EXPECT_EQ(made.turnsOn(0).at_vertex.cost_J, cost.turn(costmap::CellCode({0.0, 0.0, 0})).cost_J);
}

TEST(Kinematics, AckermannSteeringRequiresATurningRadius) {
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  const costmap::TravelCost cost({}, std::vector<costmap::TravelCurve>{});
  parts.rover.steering = terramech::Steering::Ackermann;
  parts.rover.turning_radius_m = 0.0;
  EXPECT_REFUSED(kinematicsOn(costmap::GroundModel(parts), cost), std::invalid_argument,
                 "turning_radius_m = 0, must be > 0 with steering ackermann");
}

}  // namespace kinematics_test
}  // namespace talus::planner
