#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include <terramech/soil_posterior.hpp>
#include <terramech/thesis_runs.hpp>

namespace talus::terramech {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

TEST(SoilPosterior, FindsTheSoilOfExactReadings) {
  // Property: with 0.1 % errors assumed and none made, c within 0.1 kPa and phi within 0.5 deg (worst of
  // eight soils).
  ThesisRuns runs(5);
  for (int k = 0; k < 8; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    const auto p =
        fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = ReadingErrors::relative(1e-3)});
    EXPECT_NEAR(p.mean.cohesion_Pa, run.soil.cohesion_Pa, 200.0);
    EXPECT_NEAR(p.mean.friction_angle_rad, run.soil.friction_angle_rad, 0.5 * kDegree);
    EXPECT_NEAR(p.mean.shear_modulus_m, run.soil.shear_modulus_m, 0.001);
    EXPECT_GT(p.class_probabilities[static_cast<std::size_t>(run.soil_class)], 0.5);
    EXPECT_LT(p.misfit, 1.0);
  }
}

TEST(SoilPosterior, BeatsThePriorMeanAndKnowsItsError) {
  // Property: over 60 soils with 5 % errors the rms error is below that of always answering the prior mean
  // (2.3 kPa, 4.9 deg), agrees with the posterior's own standard deviation to a third, and 95 % intervals
  // hold the truth 85 to 100 %.
  ThesisRuns runs(9);
  double c2 = 0.0, phi2 = 0.0, own_c2 = 0.0, own_phi2 = 0.0;
  int inside = 0;
  constexpr int kSoils = 60;
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05});
    const SoilPosterior p = fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = {}, .draws = 64});
    c2 += std::pow(p.mean.cohesion_Pa - run.soil.cohesion_Pa, 2) / kSoils;
    phi2 += std::pow(p.mean.friction_angle_rad - run.soil.friction_angle_rad, 2) / kSoils;
    own_c2 += p.covariance(0, 0) / kSoils;
    own_phi2 += p.covariance(1, 1) / kSoils;
    inside += run.soil.cohesion_Pa >= p.cohesion_Pa.low && run.soil.cohesion_Pa <= p.cohesion_Pa.high;
  }
  EXPECT_LT(std::sqrt(c2), 1900.0);
  EXPECT_LT(std::sqrt(phi2), 4.4 * kDegree);
  EXPECT_NEAR(std::sqrt(c2 / own_c2), 1.0, 0.33);
  EXPECT_NEAR(std::sqrt(phi2 / own_phi2), 1.0, 0.33);
  EXPECT_GE(inside, 51);
}

TEST(SoilPosterior, ShrugsOffAnOutlier) {
  // Property: one torque read at twice its value moves the answer by less than its own standard deviation.
  ThesisRuns runs(21);
  ThesisRun run = runs.next({.noise = 0.02});
  const SoilFitOptions options{.noise = ReadingErrors::relative(0.02)};
  const SoilPosterior clean = fitSoil(kThesisWheel, run.samples, thesisSoils(), options);
  run.samples[4].torque_Nm *= 2.0;
  const SoilPosterior dirty = fitSoil(kThesisWheel, run.samples, thesisSoils(), options);
  EXPECT_LT(std::abs(dirty.mean.cohesion_Pa - clean.mean.cohesion_Pa),
            std::sqrt(clean.covariance(0, 0)) + 100.0);
  EXPECT_LT(std::abs(dirty.mean.friction_angle_rad - clean.mean.friction_angle_rad),
            std::sqrt(clean.covariance(1, 1)) + 0.5 * kDegree);
}

TEST(SoilPosterior, FindsASoilFarFromTheMiddleOfAWidePrior) {
  // Property: at 1 % errors every sample is an outlier at the prior's middle; the soil must be found all the
  // same.
  ThesisRuns runs(14);
  const ThesisRun run = runs.next({.noise = 0.01});
  const SoilMixture wide{thesisSoilsOrOther(0.5).back()};
  SoilFitOptions options;
  options.noise = ReadingErrors::relative(0.01);
  const SoilPosterior p = fitSoil(kThesisWheel, run.samples, wide, options);
  EXPECT_LT(p.misfit, 3.0);
  EXPECT_NEAR(p.mean.sinkage_exponent, run.soil.sinkage_exponent, 4.0 * std::sqrt(p.covariance(2, 2)) + 0.02);
}

TEST(SoilPosterior, SaysWhatAlikeSamplesDoNotShow) {
  // Property: twelve samples at one slip of 0.8, where the shear is nearly developed, say little of K.
  ThesisRuns runs(2);
  ThesisRun run = runs.next({.noise = 0.05});
  const std::vector<WheelSample> same(3, run.samples[6]);
  const SoilPosterior p = fitSoil(kThesisWheel, same, thesisSoils());
  EXPECT_THAT(p.unseen, testing::Contains(testing::StartsWith("shear_modulus_m: ")));
}

TEST(SoilPosterior, IsTheSameEveryTime) {
  ThesisRuns runs(4);
  const ThesisRun run = runs.next({.noise = 0.05});
  const auto once = fitSoil(kThesisWheel, run.samples, thesisSoils());
  const auto again = fitSoil(kThesisWheel, run.samples, thesisSoils());
  EXPECT_EQ(once.mean.cohesion_Pa, again.mean.cohesion_Pa);
  EXPECT_EQ(once.strength_covariance, again.strength_covariance);
}

TEST(SoilPosterior, RefusesWhatIsNoDrivenWheel) {
  const WheelSample good{.load_N = 80, .torque_Nm = 3, .sinkage_m = 0.02, .slip = 0.4};
  WheelSample braked = good;
  braked.slip = -0.1;
  WheelSample buried = good;
  buried.sinkage_m = 0.15;
  EXPECT_THROW((void)fitSoil(kThesisWheel, std::vector{braked}, thesisSoils()), std::invalid_argument);
  EXPECT_THROW((void)fitSoil(kThesisWheel, std::vector{buried}, thesisSoils()), std::invalid_argument);
  EXPECT_THROW((void)fitSoil(kThesisWheel, std::vector<WheelSample>{}, thesisSoils()), std::domain_error);
}

}  // namespace
}  // namespace talus::terramech
