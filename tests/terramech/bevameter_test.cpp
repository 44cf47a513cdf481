#include <cmath>
#include <random>
#include <stdexcept>

#include <terramech/bevameter.hpp>

namespace talus::terramech {
namespace {

PressureSinkageFit pressed(std::initializer_list<double> widths, double noise = 0.0) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  PressureSinkageFit fit;
  for (const double b : widths) {
    for (int i = 1; i <= 400; ++i) {
      const double z = 1e-4 * i;
      fit.add({b, z, (13190.0 / b + 692150.0) * std::pow(z, 0.5) * (1.0 + noise * normal(random))});
    }
  }
  return fit;
}

TEST(PressureSinkageFit, GivesBackTheSoilThatMadeTheReadings) {
  // Printed in: thesis Table A.1, clayey soil: n = 0.5, k_c = 13.19, k_phi = 692.15 (kN).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2}).estimate();
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 1e-12);
  ASSERT_TRUE(fit.cohesive_modulus && fit.frictional_modulus);
  EXPECT_NEAR(*fit.cohesive_modulus, 13190.0, 1e-5);
  EXPECT_NEAR(*fit.frictional_modulus, 692150.0, 1e-4);
  EXPECT_LT(fit.residual_std, 1e-7);
}

TEST(PressureSinkageFit, RefusesToSeparateModuliWithOneOrAlikePlates) {
  for (const auto& fit : {pressed({0.05}).estimate(), pressed({0.05, 0.055}).estimate()}) {
    EXPECT_FALSE(fit.cohesive_modulus);
    EXPECT_FALSE(fit.frictional_modulus);
    EXPECT_THAT(fit.refused, testing::HasSubstr("cannot be told apart"));
    EXPECT_NEAR(fit.plates.front().sinkage_modulus, 13190.0 / 0.05 + 692150.0, 1e-4);
  }
}

TEST(PressureSinkageFit, ScatterIsWhatWasPutIn) {
  // Property: 5 % of noise on each pressure shows as a scatter of 0.05 (1200 readings: +- 4 %, two standard deviations).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2}, 0.05).estimate();
  EXPECT_NEAR(fit.residual_std, 0.05, 0.002);
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 0.01);
}

TEST(PressureSinkageFit, RefusesWhatIsNoReading) {
  PressureSinkageFit fit;
  EXPECT_THROW(fit.add({0.05, 0.0, 1000.0}), std::invalid_argument);
  EXPECT_THROW(fit.add({0.05, 0.01, std::nan("")}), std::invalid_argument);
  fit.add({0.05, 0.01, 1000.0});
  EXPECT_THROW((void)fit.estimate(), std::domain_error);
}

std::vector<ShearReading> sheared(double modulus, double furthest_m) {
  std::vector<ShearReading> readings;
  for (const double sigma : {5000.0, 10000.0, 20000.0}) {
    for (int i = 1; i <= 15; ++i) {
      const double j = furthest_m * i / 15.0;
      readings.push_back({sigma, (740.0 + sigma * 0.62) * (1.0 - std::exp(-j / modulus)), j});
    }
  }
  return readings;
}

TEST(FitShear, GivesBackAllThreeParameters) {
  // Closed form: Eq. A.4.
  const ShearFit fit = fitShear(sheared(0.013, 0.05));
  EXPECT_NEAR(fit.shear_modulus_m, 0.013, 1e-8);
  EXPECT_NEAR(fit.strength.cohesion_Pa, 740.0, 1e-2);
  EXPECT_NEAR(fit.strength.tan_friction, 0.62, 1e-6);
  EXPECT_FALSE(fit.modulus_at_bound);
}

TEST(FitShear, ThreeKIsWhereNinetyFivePerCentOfTheStrengthIsReached) {
  // Printed in: thesis A.2 (K is a third of the displacement at 95 % of tau_max).
  EXPECT_NEAR(1.0 - std::exp(-3.0), 0.95, 0.001);
}

TEST(FitShear, RefusesOneNormalStress) {
  EXPECT_THROW((void)fitShear(std::vector<ShearReading>(5, {1e4, 6e3, 0.05})), std::domain_error);
}

}  // namespace
}  // namespace talus::terramech
