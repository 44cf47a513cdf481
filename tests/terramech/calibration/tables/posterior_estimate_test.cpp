#include <cmath>

#include <talus/terramech/calibration/tables/posterior_estimate.hpp>

#include "calibration/wheel_table.hpp"

namespace talus::terramech {
namespace posterior_estimate_test {

using testing::Contains;
using testing::HasSubstr;

TEST(PosteriorEstimate, EstimateEqualsPosteriorMean) {
  const WheelTable table;
  const SoilEstimate found =
      posteriorEstimate({.table = table.path(), .method = "wong-reece", .noise = 0.01}, {});
  ASSERT_TRUE(found.posterior);
  EXPECT_EQ(found.cohesion_Pa, found.posterior->mean.cohesion_Pa);
  EXPECT_EQ(found.frictional_modulus, found.posterior->mean.sinkage_modulus);
  EXPECT_EQ(found.class_names.size(), found.posterior->class_probabilities.size());
  // Property: the soil of the rows lies within three standard deviations of the estimate.
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 3.0 * std::sqrt(found.covariance(0, 0)));
  EXPECT_NEAR(found.tan_friction, std::tan(kMadeSoil.friction_angle_rad),
              3.0 * std::sqrt(found.covariance(1, 1)));
  EXPECT_TRUE(found.warnings.empty());
}

TEST(PosteriorEstimate, StatedShearModulusIsKept) {
  const WheelTable table;
  EXPECT_NEAR(posteriorEstimate({.table = table.path(), .shear_modulus = "0.02"}, {}).shear_modulus_m, 0.02,
              1e-12);
}

TEST(PosteriorEstimate, RecursiveEstimateHasAResultPerRowWithDecreasingVariance) {
  const WheelTable table;
  const EstimateOptions options{.table = table.path(), .recursive = true, .noise = 0.02};
  const SoilEstimate found = posteriorEstimate(options, {});
  ASSERT_EQ(found.running.size(), 12U);
  EXPECT_EQ(found.running.front().line, 2U);
  EXPECT_EQ(found.running.back().cohesion_Pa, found.cohesion_Pa);
  // Property: additional rows reduce the variance.
  EXPECT_LT(found.running.back().covariance(1, 1), found.running.front().covariance(1, 1));
}

// Rows of one load whose torque increases by step_Nm from row to row.
std::string torqueRows(double first_Nm, double step_Nm) {
  std::string text = kWheelHead + "\n";
  for (int k = 0; k < 12; ++k)
    text += wheelLine({100.0, first_Nm + step_Nm * k, 0.01, 0.1 + 0.05 * k}, kMadeWheel) + "\n";
  return text;
}

TEST(PosteriorEstimate, RowBeyondTheAxleIsExcludedWithItsLineNumber) {
  const std::string rows = torqueRows(5.0, 0.2);
  const test::TemporaryFile sound{rows}, deep{rows + wheelLine({100.0, 8.0, 0.17, 0.6}, kMadeWheel) + "\n"};
  const SoilEstimate of_sound = posteriorEstimate({.table = sound.path()}, {}),
                     of_deep = posteriorEstimate({.table = deep.path()}, {});
  EXPECT_EQ(of_deep.cohesion_Pa, of_sound.cohesion_Pa);
  ASSERT_EQ(of_deep.rejected.size(), 1U);
  EXPECT_EQ(of_deep.rejected[0].line, 14U);
  EXPECT_THAT(of_deep.rejected[0].reason, HasSubstr("sinkage_m = 0.17, must be < 0.15"));
}

TEST(PosteriorEstimate, MixedWheelWidthsAndImplausibleTorquesProduceWarnings) {
  std::string widths = kWheelHead + "\n";
  for (int k = 0; k < 12; ++k) {
    const Wheel wheel{.radius_m = 0.15, .width_m = k % 2 ? 0.1 : 0.15};
    const WheelForces f = equilibrium(kMadeSoil, wheel, madeOperation(k));
    widths +=
        wheelLine({madeOperation(k).load_N, f.torque_Nm, f.sinkage_m, madeOperation(k).slip}, wheel) + "\n";
  }
  const test::TemporaryFile two{widths};
  EXPECT_THAT(posteriorEstimate({.table = two.path()}, {}).warnings,
              Contains(HasSubstr("0.1 to 0.15 m wide")));
  // A torque of plausible size that falls by half with increasing slip, as on no soil.
  const test::TemporaryFile falling{torqueRows(15.0, -0.6)};
  EXPECT_THAT(posteriorEstimate({.table = falling.path(), .noise = 0.02}, {}).warnings,
              Contains(HasSubstr("no soil of the prior")));
}

// Property: a torque three times that of any soil under the load is rejected without an estimate.
TEST(PosteriorEstimate, ImplausibleTorqueIsRejectedNamingTheColumn) {
  const test::TemporaryFile none{torqueRows(45.0, 1.0)};
  EXPECT_THAT([&] { posteriorEstimate({.table = none.path()}, {}); },
              testing::ThrowsMessage<std::domain_error>(testing::AllOf(
                  HasSubstr(none.path() + ": no soil explains the rows"), HasSubstr("torque_Nm"))));
}

}  // namespace posterior_estimate_test
}  // namespace talus::terramech
