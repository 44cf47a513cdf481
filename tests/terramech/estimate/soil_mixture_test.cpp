#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {
namespace soil_mixture_test {

TEST(SoilMixture, ThesisSoilsSpanTable21) {
  // Printed in: thesis Table 2.1.
  const SoilMixture soils = thesisSoils();
  ASSERT_EQ(soils.size(), 4u);
  const ContactSoil clay = soils[1].at(SoilVector::Zero());
  EXPECT_NEAR(clay.cohesion_Pa, 5000.0, 1e-9);
  EXPECT_NEAR(clay.friction_angle_rad / kDegree, 20.0, 1e-9);
  EXPECT_NEAR(clay.sinkage_exponent, 0.5, 1e-12);
  const ContactSoil firm = soils[3].at(SoilVector::Ones());
  EXPECT_NEAR(firm.sinkage_modulus, 3e6, 1e-3);
  EXPECT_NEAR(firm.shear_modulus_m, 0.03, 1e-12);
}

TEST(SoilMixture, ProbabilitiesSumToOne) {
  double sum = 0.0;
  for (const SoilClass& soil : thesisSoilsOrOther(0.1)) sum += soil.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Marginal, SlopeIsTheDerivative) {
  // Property: slope() equals central differences.
  for (const Marginal& m :
       {Marginal::uniform(2.0, 5.0), Marginal::logUniform(0.1, 10.0), Marginal::normal(1.0, 0.3, 0.0)}) {
    for (const double y : {0.2, 0.5, 0.9}) {
      EXPECT_NEAR((m.at(y + 1e-6) - m.at(y - 1e-6)) / 2e-6, m.slope(y), 1e-6 * (1.0 + m.slope(y)));
    }
  }
}

TEST(Marginal, FixedIsConstantAndNormalIsBoundedBelow) {
  EXPECT_EQ(Marginal::fixed(3.0).at(0.9), 3.0);
  EXPECT_EQ(Marginal::fixed(3.0).slope(0.9), 0.0);
  EXPECT_EQ(Marginal::normal(1.0, 1.0, 0.0).at(-5.0), 0.0);
  EXPECT_EQ(Marginal::normal(1.0, 1.0, 0.0).slope(-5.0), 0.0);
}

TEST(Marginal, InvalidBoundsAreRejected) {
  EXPECT_REFUSED(Marginal::uniform(2.0, 2.0), std::invalid_argument, "upper bound = 2, must be > 2");
  EXPECT_REFUSED(Marginal::logUniform(0.0, 2.0), std::invalid_argument, "lower bound = 0, must be > 0");
  EXPECT_REFUSED(Marginal::normal(0.0, 0.0, -1.0), std::invalid_argument, "std = 0, must be > 0");
}

}  // namespace soil_mixture_test
}  // namespace talus::terramech
