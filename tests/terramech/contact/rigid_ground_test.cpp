#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/rigid_ground.hpp>

namespace talus::terramech {
namespace rigid_ground_test {

TEST(RigidGround, PullIsTorqueOverRadiusUpToTheFrictionLimit) {
  const Wheel wheel{.radius_m = 0.2, .width_m = 0.1};
  const GroundFriction friction{.static_coefficient = 0.7, .kinetic_coefficient = 0.5};
  // Closed form: C.11.
  EXPECT_DOUBLE_EQ(rigidGroundForces(wheel, friction, 100.0, 10.0).drawbar_pull_N, 50.0);
  EXPECT_FALSE(rigidGroundForces(wheel, friction, 100.0, 0.2 * 0.7 * 100.0).slips);
  const RigidGroundForces slipping = rigidGroundForces(wheel, friction, 100.0, -14.1);
  EXPECT_TRUE(slipping.slips);
  EXPECT_DOUBLE_EQ(slipping.drawbar_pull_N, -50.0);
}

TEST(RigidGround, InvalidLoadAndFrictionAreRejected) {
  EXPECT_REFUSED(rigidGroundForces({}, {}, 0.0, 1.0), std::invalid_argument, "load_N = 0, must be > 0");
  EXPECT_REFUSED(rigidGroundForces({}, {.static_coefficient = 0.1, .kinetic_coefficient = 0.5}, 1.0, 1.0),
                 std::invalid_argument, "static_coefficient = 0.1, must be >= 0.5");
}

}  // namespace rigid_ground_test
}  // namespace talus::terramech
