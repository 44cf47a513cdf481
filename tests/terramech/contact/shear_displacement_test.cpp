#include <cmath>

#include <talus/terramech/contact/shear_displacement.hpp>

namespace talus::terramech {
namespace shear_displacement_test {

ShearDisplacement at(double slip, double entry = 0.6) {
  return ShearDisplacement{{0.2, slip, entry}};
}

TEST(ShearDisplacement, IsEquationC6ForDrivenWheels) {
  const double entry = 0.6, theta = 0.1;
  // Closed form: C.6.
  EXPECT_DOUBLE_EQ(at(0.3).at_m(theta), 0.2 * ((entry - theta) - 0.7 * (std::sin(entry) - std::sin(theta))));
  EXPECT_DOUBLE_EQ(at(1.0).at_m(theta), 0.2 * (entry - theta));  // spinning in place: the arc rolled
}

TEST(ShearDisplacement, IntegratesTheSlidingVelocityOfARimPoint) {
  // Closed form: dj = (r omega - v cos theta) dt with d theta = -omega dt; v/(r omega) = 1/(1 + slip) for a
  // braked wheel.
  for (const double slip : {-0.6, -0.2, 0.0, 0.4}) {
    const double q = slip < 0.0 ? 1.0 / (1.0 + slip) : 1.0 - slip;
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double theta = 0.6 - 0.5 * (k + 0.5) / kSteps;
      sum += 0.2 * (1.0 - q * std::cos(theta)) * 0.5 / kSteps;
    }
    EXPECT_NEAR(at(slip).at_m(0.1), sum, 1e-10) << slip;
  }
}

TEST(ShearDisplacement, LockedWheelHasInfiniteShearDisplacement) {
  EXPECT_EQ(at(-1.0).at_m(0.3), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(at(-1.0).signChange_rad(0.0)));
}

TEST(ShearDisplacement, SignChangesOnlyForTowedWheelsAtSmallNegativeSlip) {
  EXPECT_TRUE(std::isnan(at(0.0).signChange_rad(0.0)));
  EXPECT_TRUE(std::isnan(at(-0.5).signChange_rad(0.0)));  // the rim is slower than the soil from the entry on
  const double zero = at(-0.1).signChange_rad(0.0);
  ASSERT_GT(zero, 0.0);
  EXPECT_NEAR(at(-0.1).at_m(zero), 0.0, 1e-15);
  EXPECT_GT(at(-0.1).at_m(zero + 0.05), 0.0);
  EXPECT_LT(at(-0.1).at_m(zero - 0.05), 0.0);
}

}  // namespace shear_displacement_test
}  // namespace talus::terramech
