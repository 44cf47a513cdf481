#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/strength/shear_modulus.hpp>

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
}  // namespace talus::terramech
