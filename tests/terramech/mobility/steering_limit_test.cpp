#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/effects/wheel_contact.hpp>
#include <talus/terramech/mobility/steering_limit.hpp>

namespace talus::terramech {
namespace steering_limit_test {

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 500.0,
          .friction_angle_rad = 0.56,
          .sinkage_exponent = 0.9,
          .frictional_modulus = 1.7e6,
          .shear_modulus_m = 0.02};
}

TEST(SteeringLimit, SideForceEqualsTheDemandAtTheLimit) {
  const SteeringDemand demand{.load_N = 80.0};
  const double limit = steeringSlipLimit(sand(), Wheel{}, demand);
  ASSERT_GT(limit, 0.0);
  ASSERT_LT(limit, 1.0);
  WheelContact contact = contactOf(sand(), Wheel{});
  contact.load_N = 80.0;
  contact.slip = limit;
  contact.slip_angle_rad = demand.slip_angle_rad;
  EXPECT_NEAR(std::abs(solveContact(contact).side_force_N) / 80.0, 0.1, 1e-6);  // Closed form: the root.
}

TEST(SteeringLimit, DecreasesWithDemandAndIncreasesWithSlipAngle) {
  const auto limit = [](double demand, double angle) {
    return steeringSlipLimit(sand(), Wheel{},
                             {.load_N = 80.0, .slip_angle_rad = angle, .side_force_over_load = demand});
  };
  EXPECT_GT(limit(0.05, 0.26), limit(0.1, 0.26));  // Property: monotone in the side force.
  EXPECT_GT(limit(0.1, 0.4), limit(0.1, 0.26));
  EXPECT_EQ(limit(5.0, 0.26), 0.0);
}

TEST(SteeringLimit, InvalidDemandIsRejected) {
  EXPECT_REFUSED(steeringSlipLimit(sand(), Wheel{}, {.load_N = -1.0}), std::invalid_argument,
                 "load_N = -1, must be > 0");
}

}  // namespace steering_limit_test
}  // namespace talus::terramech
