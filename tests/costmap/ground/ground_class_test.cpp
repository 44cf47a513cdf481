#include <cmath>

#include <site_fixture.hpp>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {
namespace ground_class_test {

double pull(const terramech::Soil& soil) {
  return terramech::mobilityReference(soil, testRover()).drawbar_pull_over_load;
}

TEST(GroundClass, SoilStdIsPropagatedToPullStd) {
  const terramech::SoilPrior prior{.mean = testSand(), .deviation = {.friction_angle_rad = 0.05}};
  terramech::Soil weaker = testSand(), stronger = testSand();
  weaker.friction_angle_rad -= 0.025;
  stronger.friction_angle_rad += 0.025;
  // Closed form: central difference of the one uncertain parameter.
  EXPECT_NEAR(groundClass(1, prior, testRover()).mean_std, pull(stronger) - pull(weaker), 1e-12);
}

// Property: the error message states the given standard deviation, not the soil parameter outside its
// range at which the central difference is evaluated.
TEST(GroundClass, StdOutsideTheSoilRangeIsReported) {
  const terramech::SoilPrior prior{.mean = testSand(), .deviation = {.cohesion_Pa = 1e12}};
  EXPECT_THAT(
      [&] { groundClass(1, prior, testRover()); },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(" with half of its std 1e+12")));
}

TEST(GroundClass, WithoutSoilStdTheDefaultStdIsUsed) {
  EXPECT_EQ(groundClass(1, {.mean = testSand(), .deviation = {}}, testRover()).mean_std,
            GroundClass{}.mean_std);
}

// Property: a test under the Earth's gravity yields weaker and less certain ground on the Moon; under the
// test's own gravity the values are unchanged.
TEST(GroundClass, LowerGravityThanTestedWeakensAndIncreasesStd) {
  terramech::SoilPrior prior{.mean = testSand(), .deviation = {}};
  terramech::Rover rover = testRover();
  const GroundClass as_stated = groundClass(1, prior, rover);
  prior.mean.test_gravity_m_s2 = rover.gravity_m_s2;
  EXPECT_EQ(groundClass(1, prior, rover).mean_std, as_stated.mean_std);
  EXPECT_EQ(groundClass(1, prior, rover).soil.frictional_modulus, as_stated.soil.frictional_modulus);
  prior.mean.test_gravity_m_s2 = 4.0 * rover.gravity_m_s2;
  const GroundClass weaker = groundClass(1, prior, rover);
  EXPECT_DOUBLE_EQ(weaker.soil.frictional_modulus, 0.25 * as_stated.soil.frictional_modulus);
  EXPECT_LT(pull(weaker.soil), pull(as_stated.soil));
  terramech::Soil half = testSand();
  half.cohesion_Pa *= 0.5;
  half.frictional_modulus *= 0.5;
  half.cohesive_modulus *= 0.5;
  EXPECT_NEAR(weaker.mean_std, std::hypot(as_stated.mean_std, pull(half) - pull(weaker.soil)), 1e-12);
}

terramech::RefinedModel digging() {
  terramech::RefinedModel model;
  model.soil = testSand();
  model.effects = {{.name = "slip_sinkage_ding", .covariate = "slip", .parameters = {0.5}},
                   {.name = "load_cell_tilt", .covariate = "constant", .parameters = {0.1}}};
  model.fitted = {{.effect = 0, .index = 0}};
  model.covariance = {0.0016};
  return model;
}

TEST(GroundClass, RefinedModelKeepsItsGroundEffects) {
  const GroundClass ground = groundClass(3, digging(), testRover());
  ASSERT_EQ(ground.effects.size(), 1U);
  EXPECT_EQ(ground.effects[0].name, "slip_sinkage_ding");
  // Property: slip sinkage makes the wheel sink deeper than in plain sand and weakens the pull at the
  // reference slip.
  EXPECT_LT(referenceOf(ground, testRover()).drawbar_pull_over_load, pull(testSand()));
}

TEST(GroundClass, PullStdFollowsFromTheModelCovariance) {
  terramech::RefinedModel more = digging(), less = digging();
  more.effects[0].parameters[0] += 0.004;
  less.effects[0].parameters[0] -= 0.004;
  const auto at = [](const terramech::RefinedModel& m) {
    return terramech::mobilityReference(m, testRover()).drawbar_pull_over_load;
  };
  // Closed form: |dDP/dn1| times the standard deviation 0.04. Tolerance 2 %: a central against a one-sided
  // difference.
  const double expected = std::abs(at(more) - at(less)) / 0.008 * 0.04;
  EXPECT_NEAR(groundClass(3, digging(), testRover()).mean_std, expected, 0.02 * expected);
}

}  // namespace ground_class_test
}  // namespace talus::costmap
