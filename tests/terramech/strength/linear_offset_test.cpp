#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/strength/linear_offset.hpp>

#include "linear_world.hpp"

namespace talus::terramech {
namespace linear_offset_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.08};

TEST(LinearOffset, WholeEquationIsExactForLinearStresses) {
  // Property: Eq. 2.9 follows from Eqs. 2.1 to 2.8 without further approximation (only with 2.3 corrected).
  const LinearWorld world{.cohesion_Pa = 5000.0, .tan_friction = 0.45};
  for (const WheelSample& s : linearSamples(kWheel, world)) {
    const LinearOffsetCoefficients m = linearOffset(kWheel, s, world.shear_modulus_m);
    const double left = m.m1 * 5000.0 * 0.45 + 5000.0 + m.m3_Pa * 0.45;
    EXPECT_NEAR(left, m.m4_Pa, 1e-5 * m.m4_Pa);  // tolerance: midpoint rule of the samples
  }
}

TEST(LinearOffset, StressesAreRecoveredFromLoadAndTorque) {
  // Property: the estimated stresses equal those of the world.
  const LinearWorld world;
  const WheelSample s = sampleOf(kWheel, world, {.sinkage_m = 0.02, .slip = 0.5});
  const ShearSoil soil{.cohesion_Pa = world.cohesion_Pa, .shear_modulus_m = world.shear_modulus_m};
  const LinearOffsetStresses stress = linearOffsetStresses(kWheel, s, soil);
  EXPECT_NEAR(stress.sigma_m_Pa, world.sigma_m_Pa, 1e-5 * world.sigma_m_Pa);
  const double a = mobilisation(kWheel, s, world.shear_modulus_m).peak;
  EXPECT_NEAR(stress.tau_m_Pa, (world.cohesion_Pa + world.sigma_m_Pa * world.tan_friction) * a, 0.5);
}

TEST(LinearOffset, M1MatchesItsSmallAngleLimit) {
  // Closed form: M1 ~ (theta_1/6) B / (1 + B/2A) > 0 at small contact.
  const WheelSample s{.load_N = 10.0, .torque_Nm = 0.2, .sinkage_m = 1e-6, .slip = 0.5};
  const auto [a, b] = mobilisation(kWheel, s, 1e-4);
  const double theta_1 = entryAngle_rad(kWheel, s.sinkage_m);
  EXPECT_NEAR(linearOffset(kWheel, s, 1e-4).m1 / (theta_1 / 6.0 * b / (1.0 + b / (2.0 * a))), 1.0, 1e-5);
}

TEST(LinearOffset, WheelWithoutMobilisedShearIsRejected) {
  EXPECT_REFUSED(linearOffset(kWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.01, .slip = -0.5}, 0.02),
                 std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
  EXPECT_REFUSED(linearOffset(kWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.0, .slip = 0.5}, 0.02),
                 std::invalid_argument, "sinkage_m = 0, must be > 0");
}

}  // namespace linear_offset_test
}  // namespace talus::terramech
