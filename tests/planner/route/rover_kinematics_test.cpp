#include <stdexcept>

#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/planner/route/rover_kinematics.hpp>

namespace talus::planner {
namespace rover_kinematics_test {

TEST(RoverKinematics, TurnsCostWhatTheMapsCostSays) {
  const auto model = costmap::testGround();
  const costmap::DriveCost cost(model->limits(),
                                std::vector<costmap::DriveGround>{model->ground(0, model->prior(0))});
  const Kinematics made = kinematicsOn(*model, cost);
  ASSERT_EQ(made.turns_by_curve.size(), 1U);
  EXPECT_GT(made.turnsOn(0).in_place.energy_J, 0.0);
  EXPECT_EQ(made.turnsOn(0).at_vertex.cost_J, cost.turn(costmap::CellCode({0.0, 0.0, 0})).cost_J);
}

TEST(RoverKinematics, AnAckermannRoverNeedsARadius) {
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  const costmap::DriveCost cost({}, std::vector<costmap::DriveCurve>{});
  parts.rover.steering = terramech::Steering::Ackermann;
  parts.rover.turning_radius_m = 0.0;
  EXPECT_REFUSED(kinematicsOn(costmap::GroundModel(parts), cost), std::invalid_argument,
                 "turning_radius_m = 0, must be > 0 with steering ackermann");
}

}  // namespace rover_kinematics_test
}  // namespace talus::planner
