#include <cmath>
#include <numbers>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {
namespace soil_estimate_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SoilEstimate, StatedModulusMustBePositiveAndFinite) {
  EXPECT_EQ(statedModulus({.shear_modulus = "0.02"}), 0.02);
  EXPECT_EQ(statedModulus({.shear_modulus = "2e-2"}), 0.02);
  for (const char* word : {"", "joint", "0.02m", "0.02 ", "effective-torque"})
    EXPECT_FALSE(statedModulus({.shear_modulus = word})) << word;
  for (const char* word : {"0", "-0.02", "inf", "nan"})
    EXPECT_THAT([&] { statedModulus({.shear_modulus = word}); },
                ThrowsMessage<InputError>(HasSubstr("must be > 0 [m]")))
        << word;
}

TEST(SoilEstimate, FrictionStdFollowsFromTangentStdByTheDeltaMethod) {
  // Closed form: d(phi) = d(tan phi) cos^2(phi) for the friction angle phi; the factor is 1/4 at 60 deg.
  Eigen::Matrix2d covariance;
  covariance << 1e4, 3.0, 3.0, 0.01;
  EXPECT_NEAR(frictionStd_rad(covariance, std::numbers::pi / 3), 0.025, 1e-12);
}

TEST(SoilEstimate, DefaultEstimateIsNan) {
  const SoilEstimate estimate;
  EXPECT_TRUE(std::isnan(estimate.cohesion_Pa));
  EXPECT_TRUE(std::isnan(estimate.friction_angle_rad));
  EXPECT_TRUE(std::isnan(estimate.covariance(0, 0)));
  EXPECT_FALSE(estimate.cohesive_modulus);
}

TEST(SoilEstimate, CopiesStrengthAndCovarianceOfAFittedLine) {
  SoilEstimate estimate;
  estimate.unseen = {"before"};
  ShearStrength fit;
  fit.cohesion_Pa = 700.0;
  fit.tan_friction = 1.0;
  fit.covariance << 4.0, 0.0, 0.0, 0.01;
  fit.unseen = {"after"};
  estimate.take(fit);
  EXPECT_EQ(estimate.cohesion_Pa, 700.0);
  EXPECT_NEAR(estimate.friction_angle_rad, std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(estimate.covariance(1, 1), 0.01);
  EXPECT_THAT(estimate.unseen, testing::ElementsAre("before", "after"));
}

TEST(SoilEstimate, ImplausibleIsBeyondTwoStandardDeviationsOfPlausibleBounds) {
  SoilEstimate estimate;
  estimate.covariance << 1e4, 0.0, 0.0, 0.01;  // standard deviations 100 Pa and 0.1
  const auto said = [&](double cohesion_Pa, double tan_friction) {
    estimate.cohesion_Pa = cohesion_Pa;
    estimate.tan_friction = tan_friction;
    return estimate.implausible();
  };
  // Closed form: the limits are two standard deviations, 200 Pa and 0.2, beyond the physical range.
  EXPECT_EQ(said(-199.0, 0.5), "");
  EXPECT_THAT(said(-201.0, 0.5), testing::StartsWith("a cohesion outside"));
  EXPECT_EQ(said(0.0, -0.19), "");
  EXPECT_THAT(said(0.0, -0.21), testing::StartsWith("a friction angle"));
  EXPECT_EQ(said(0.0, std::tan(std::numbers::pi / 3) + 0.19), "");
  EXPECT_THAT(said(0.0, std::tan(std::numbers::pi / 3) + 0.21), testing::StartsWith("a friction angle"));
  EXPECT_THAT(said(-201.0, -0.21), testing::StartsWith("a cohesion and a friction angle"));
}

}  // namespace soil_estimate_test
}  // namespace talus::terramech
