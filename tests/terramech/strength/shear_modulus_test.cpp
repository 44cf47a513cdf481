#include <cmath>
#include <stdexcept>

#include <refused.hpp>
#include <thesis_runs.hpp>

#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

#include "linear_world.hpp"

namespace talus::terramech {

namespace shear_modulus_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

// Samples under the assumptions of D.8: one load, one sinkage, slip from 0.1 to 0.8, no cohesion.
std::vector<WheelSample> steadyRun(double modulus) {
  std::vector<WheelSample> samples;
  for (int k = 1; k <= 8; ++k) {
    const LinearWorld world{.cohesion_Pa = 0.0, .tan_friction = 0.6, .shear_modulus_m = modulus};
    WheelSample s = sampleOf(kWheel, world, {.sinkage_m = 0.015, .slip = 0.1 * k});
    s.load_N = 80.0;
    samples.push_back(s);
  }
  return samples;
}

TEST(ShearModulus, TorqueRatioIsExactUnderItsAssumptions) {
  // Property: A(i)/A(i_max) = T/T_max for constant load and sinkage and c = 0.
  EXPECT_NEAR(modulusByTorqueRatio(kWheel, steadyRun(0.02)).shear_modulus_m, 0.02, 1e-5);
}

TEST(ShearModulus, EffectiveTorqueAsPrintedUnderestimatesTheModulus) {
  // Property: the result is too low, because the method takes A(i_max), here 0.6, as 1 (thesis D.8).
  const double k = modulusByEffectiveTorque(kWheel, steadyRun(0.02)).shear_modulus_m;
  EXPECT_LT(k, 0.75 * 0.02);
  EXPECT_GT(k, 0.3 * 0.02);
}

TEST(ShearModulus, ErrorMinimisationIsAccurateForLinearStresses) {
  // Property: at the true K the points lie on a line except for M1 (6 %).
  const auto estimate = modulusByErrorMinimisation(kWheel, linearSamples(kWheel, {.cohesion_Pa = 500.0}));
  EXPECT_NEAR(estimate.shear_modulus_m, 0.02, 0.002);
  EXPECT_FALSE(estimate.at_bound);
}

TEST(ShearModulus, JointFitIsAccurateForLinearStresses) {
  const auto samples = linearSamples(kWheel, {.cohesion_Pa = 500.0});
  EXPECT_NEAR(modulusJointly(kWheel, samples).shear_modulus_m, 0.02, 0.002);
}

TEST(ShearModulus, ConstantSlipIsRejected) {
  const auto run = steadyRun(0.02);
  const std::vector<WheelSample> same(5, run.front());
  EXPECT_REFUSED(modulusByTorqueRatio(kWheel, same), std::domain_error,
                 "no sample has less slip and less torque per load");
  EXPECT_REFUSED(modulusByEffectiveTorque(kWheel, same), std::domain_error,
                 "no sample has less slip and less torque per load");
}

}  // namespace shear_modulus_test

namespace shear_modulus_grid_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

ShearModulusGrid ladderOver(std::span<const WheelSample> samples, const ShearModulusGrid::Options& options) {
  ShearModulusGrid ladder(kWheel, options);
  for (const WheelSample& s : samples) EXPECT_TRUE(ladder.add(s));
  return ladder;
}

// Samples under the assumptions of App. D.8: one load, one sinkage, no cohesion.
std::vector<WheelSample> steadyRun(double modulus) {
  std::vector<WheelSample> samples;
  for (int k = 1; k <= 8; ++k) {
    const LinearWorld world{.cohesion_Pa = 0.0, .tan_friction = 0.6, .shear_modulus_m = modulus};
    samples.push_back(sampleOf(kWheel, world, {.sinkage_m = 0.015, .slip = 0.1 * k}));
    samples.back().load_N = 80.0;
  }
  return samples;
}

TEST(ShearModulusGrid, JointFitMatchesTheBatchFitWithinGridSpacing) {
  // Property: the grid, refined by a parabola between values 28 % apart, equals the joint estimate.
  const auto samples = linearSamples(kWheel, {.cohesion_Pa = 1000.0});
  EXPECT_NEAR(
      ladderOver(samples, {}).modulus().shear_modulus_m / modulusJointly(kWheel, samples).shear_modulus_m,
      1.0, 0.05);
}

TEST(ShearModulusGrid, ErrorMinimisationMatchesTheBatchFitWithinGridSpacing) {
  // Property: both criteria have their minimum at the K for which the points lie on a line.
  const auto samples = linearSamples(kWheel, {.cohesion_Pa = 500.0});
  const auto ladder = ladderOver(samples, {.criterion = ModulusCriterion::ErrorMinimisation});
  EXPECT_NEAR(ladder.modulus().shear_modulus_m / modulusByErrorMinimisation(kWheel, samples).shear_modulus_m,
              1.0, 0.05);
}

TEST(ShearModulusGrid, TorqueRatioIsExactUnderItsAssumptions) {
  for (const double truth : {0.006, 0.02, 0.05}) {
    const auto ladder = ladderOver(steadyRun(truth), {.criterion = ModulusCriterion::TorqueRatio});
    // Tolerance: accuracy of the parabola through values 28 % apart.
    EXPECT_NEAR(ladder.modulus().shear_modulus_m / truth, 1.0, 0.03) << truth;
    EXPECT_FALSE(ladder.modulus().at_bound);
  }
}

TEST(ShearModulusGrid, EffectiveTorqueIsAccurateOnlyAtFullMobilisation) {
  // Property: if A(i_max) is 1, that is for K far below j, both forms of D.8 agree; otherwise the printed
  // form is too low.
  const auto at = [](double truth, ModulusCriterion c) {
    return ladderOver(steadyRun(truth), {.criterion = c}).modulus().shear_modulus_m;
  };
  EXPECT_NEAR(at(0.003, ModulusCriterion::EffectiveTorque) / 0.003, 1.0, 0.05);
  EXPECT_LT(at(0.02, ModulusCriterion::EffectiveTorque), 0.75 * 0.02);
}

TEST(ShearModulusGrid, MaximumSlipSampleIsExcludedFromItsOwnEquation) {
  // Property: with the highest slip and one lower slip, sampled three times, K solves A(i) = T/T_max, K = -j
  // / ln(1 - T/T_max), as in the batch form (thesis D.8 as printed).
  const auto run = steadyRun(0.02);
  const std::vector<WheelSample> samples{run[2], run[2], run[2], run.back()};
  const auto ladder = ladderOver(samples, {.criterion = ModulusCriterion::EffectiveTorque});
  EXPECT_NEAR(ladder.modulus().shear_modulus_m / modulusByEffectiveTorque(kWheel, samples).shear_modulus_m,
              1.0, 0.05);
}

TEST(ShearModulusGrid, ResultIsIndependentOfSampleOrder) {
  // Property: the result does not depend on the position of the highest slip.
  const auto samples = steadyRun(0.02);
  const std::vector<WheelSample> back(samples.rbegin(), samples.rend());
  for (const auto c : {ModulusCriterion::EffectiveTorque, ModulusCriterion::TorqueRatio}) {
    EXPECT_NEAR(ladderOver(samples, {.criterion = c}).modulus().shear_modulus_m,
                ladderOver(back, {.criterion = c}).modulus().shear_modulus_m, 1e-12);
  }
}

TEST(ShearModulusGrid, StrengthIsThatOfTheRequestedMethod) {
  // Property: in a world without shear at the bottom, Iagnemma's line at the true K is exact.
  const LinearWorld world{.cohesion_Pa = 1500.0, .offset = false};
  const auto samples = linearSamples(kWheel, world);
  MohrCoulombLine line;
  for (const WheelSample& s : samples) line.add(iagnemmaPair(kWheel, s, world.shear_modulus_m));
  ASSERT_NEAR(line.estimate().cohesion_Pa, 1500.0, 1.0);
  ShearModulusGrid ladder(
      kWheel, {.pair = iagnemmaPair,
               .range = {.low_m = 0.5 * world.shear_modulus_m, .high_m = 2.0 * world.shear_modulus_m}});
  for (const WheelSample& s : samples) ladder.add(s);
  MohrCoulombLine at_k;
  for (const WheelSample& s : samples) at_k.add(iagnemmaPair(kWheel, s, ladder.modulus().shear_modulus_m));
  EXPECT_NEAR(ladder.strength().cohesion_Pa, at_k.estimate().cohesion_Pa, 5.0);
  EXPECT_NEAR(ladder.strength().tan_friction, at_k.estimate().tan_friction, 0.001);
}

TEST(ShearModulusGrid, UnusableSamplesAreSkippedAndFourAreRequired) {
  ShearModulusGrid ladder(kWheel);
  EXPECT_FALSE(ladder.add({.load_N = 80.0, .torque_Nm = -1.0, .sinkage_m = 0.01, .slip = 0.3}));
  EXPECT_FALSE(ladder.add({.load_N = 80.0, .torque_Nm = 2.0, .sinkage_m = 0.01, .slip = -0.3}));
  EXPECT_EQ(ladder.samples(), 0u);
  const auto samples = linearSamples(kWheel, {});
  for (int k = 0; k < 3; ++k) ladder.add(samples[static_cast<std::size_t>(k)]);
  EXPECT_THROW((void)ladder.modulus(), std::domain_error);
  EXPECT_THROW((void)ladder.strength(), std::domain_error);
}

}  // namespace shear_modulus_grid_test

}  // namespace talus::terramech
