#include <cmath>

#include <talus/common/common.hpp>
#include <talus/terramech/io/soil_priors.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace soil_priors_test {

const char* const kTwoSoils = R"(soils:
  - {name: a, cohesion_Pa: {mean: 1000, std: 100}, friction_angle_rad: 0.5, sinkage_exponent: 1.0, cohesive_modulus: {mean: 500, std: 30},
     frictional_modulus: {mean: 2.0e5, std: 400}, shear_modulus_m: 0.01}
  - {name: b, cohesion_Pa: 0, friction_angle_rad: 0.6, sinkage_exponent: 1.0, cohesive_modulus: 0,
     frictional_modulus: 1.0e6, shear_modulus_m: 0.03}
)";

TEST(SoilPriors, PriorsComeFromANameAFileOrAreEmpty) {
  EXPECT_TRUE(soilPriors("").empty());
  const std::string name = librarySoils().front();
  ASSERT_EQ(soilPriors(name).size(), 1U);
  EXPECT_EQ(soilPriors(name)[0].mean.cohesion_Pa, loadSoil(name).cohesion_Pa);
  const test::TemporaryFile file{kTwoSoils, ".yaml"};
  const auto both = soilPriors(file.path());
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[1].mean.name, "b");
  EXPECT_THROW(soilPriors("no_such_soil"), InputError);
}

TEST(SoilPriors, MixtureModulusAccountsForWheelWidth) {
  const test::TemporaryFile file{kTwoSoils, ".yaml"};
  const SoilMixture mixture = mixtureOf(soilPriors(file.path()), 0.1);
  ASSERT_EQ(mixture.size(), 2U);
  EXPECT_EQ(mixture[0].probability, 0.5);
  EXPECT_EQ(mixture[1].probability, 0.5);
  // Closed form: k = k_c/b + k_phi with std hypot(30/0.1, 400) = 500; y is in standard deviations.
  EXPECT_NEAR(mixture[0].parameters[3].at(0.0), 205000.0, 1e-6);
  EXPECT_NEAR(mixture[0].parameters[3].slope(0.0), 500.0, 1e-6);
  EXPECT_NEAR(mixture[0].parameters[0].at(2.0), 1200.0, 1e-9);
  // Property: a parameter without a standard deviation is fixed, and cohesion is never negative.
  EXPECT_EQ(mixture[0].parameters[1].at(0.3), 0.5);
  EXPECT_EQ(mixture[0].parameters[0].at(-20.0), 0.0);
}

TEST(SoilPriors, StrengthPriorsAndMeanShearModulusMatchTheSoils) {
  const test::TemporaryFile file{kTwoSoils, ".yaml"};
  const auto soils = soilPriors(file.path());
  const auto strengths = strengthPriors(soils);
  ASSERT_EQ(strengths.size(), 2U);
  EXPECT_DOUBLE_EQ(strengths[1].mean[1], std::tan(0.6));
  EXPECT_DOUBLE_EQ(strengths[0].covariance(0, 0), 1e4);
  EXPECT_DOUBLE_EQ(meanModulus(soils), 0.02);
}

}  // namespace soil_priors_test
}  // namespace talus::terramech
