#include <cmath>
#include <numbers>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "calibration/wheel_table.hpp"

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

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(EstimateSoil, ExactRowsRecoverTheSoil) {
  const WheelTable table;
  const SoilEstimate found =
      estimateSoil({.table = table.path(), .method = "wong-reece", .noise = 0.005}, {});
  EXPECT_EQ(found.rows_used, 12U);
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 150.0);
  EXPECT_NEAR(found.friction_angle_rad, kMadeSoil.friction_angle_rad, 0.02);
}

// Rows of the synthetic soil at slip angles to both sides, with or without the side force, multiplied by
// `times`.
std::string angledRows(bool side_force, double times = 1.0) {
  RefinedModel model;
  model.soil = kMadeSoil;
  std::string text = kWheelHead + ",slip_angle_rad" + (side_force ? ",side_force_N" : "") + "\n";
  for (int k = 0; k < 24; ++k) {
    const WheelState s{.wheel = kMadeWheel,
                       .load_N = 100.0 + 10.0 * (k % 5),
                       .slip = 0.05 + 0.02 * k,
                       .slip_angle_rad = 0.2 * (k % 4 - 1)};
    const Reading r = predict(model, s);
    text += wheelLine({s.load_N, r.torque_Nm, r.sinkage_m, s.slip}, kMadeWheel) + "," +
            std::to_string(s.slip_angle_rad);
    text += (side_force ? "," + std::to_string(times * r.side_force_N) : "") + "\n";
  }
  return text;
}

TEST(EstimateSoil, SideForcesAreFittedWithTheFullModel) {
  const test::TemporaryFile with{angledRows(true)}, without{angledRows(false)};
  const SoilEstimate found = estimateSoil({.table = with.path(), .method = "wong-reece", .noise = 0.01}, {});
  EXPECT_EQ(found.rows_used, 24U);
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 3.0 * std::sqrt(found.covariance(0, 0)));
  EXPECT_NEAR(found.tan_friction, std::tan(0.45), 3.0 * std::sqrt(found.covariance(1, 1)));
  EXPECT_LT(std::sqrt(found.covariance(1, 1)), 0.05);
  // Without side forces all rows are used too; with a linear method only the six rows of straight wheels.
  EXPECT_EQ(estimateSoil({.table = without.path(), .method = "wong-reece", .noise = 0.01}, {}).rows_used,
            24U);
  EXPECT_EQ(estimateSoil({.table = with.path(), .method = "linear-offset"}, {}).rejected.size(), 18U);
  EXPECT_THAT([&] { estimateSoil({.table = with.path(), .method = "wong-reece", .recursive = true}, {}); },
              ThrowsMessage<InputError>(HasSubstr("which fits all rows at once")));
}

// Property: side forces in a wrong unit, which no soil can explain, are rejected with the name of the column.
TEST(EstimateSoil, SideForcesInWrongUnitsAreRejectedNamingTheColumn) {
  for (const double times : {100.0, 1000.0}) {
    const test::TemporaryFile table{angledRows(true, times)};
    EXPECT_THAT([&] { estimateSoil({.table = table.path(), .method = "wong-reece"}, {}); },
                ThrowsMessage<std::domain_error>(testing::AllOf(
                    HasSubstr(table.path() + ": no soil explains the rows"),
                    HasSubstr("check unit, sign and sensor of column side_force_N, without which"))))
        << times;
  }
}

// Rows of the synthetic soil at one slip angle, with pull and with the given side force over load.
std::string heldRows(double slip_angle_rad, double side_over_load) {
  RefinedModel model;
  model.soil = kMadeSoil;
  std::string text = kWheelHead + ",drawbar_pull_N,slip_angle_rad,side_force_N\n";
  for (int k = 0; k < 20; ++k) {
    const WheelState s{.wheel = kMadeWheel,
                       .load_N = 90.0 + 10.0 * (k % 5),
                       .slip = 0.1 + 0.025 * k,
                       .slip_angle_rad = slip_angle_rad};
    const Reading r = predict(model, s);
    text += wheelLine({s.load_N, r.torque_Nm, r.sinkage_m, s.slip}, kMadeWheel) + "," +
            std::to_string(r.drawbar_pull_N) + "," + std::to_string(slip_angle_rad) + "," +
            std::to_string(side_over_load * s.load_N) + "\n";
  }
  return text;
}

// Property: a side force of a straight wheel, no side force at a slip angle, and a side force of the wrong
// sign or size are rejected with the name of the column, also for a small misfit.
TEST(EstimateSoil, ContradictorySideForceIsRejectedNamingTheColumn) {
  for (const auto& [angle, side] : {std::pair{0.0, 0.5}, {0.3, 0.0}, {0.3, 0.5}, {0.3, -1.5}}) {
    const test::TemporaryFile table{heldRows(angle, side)};
    EXPECT_THAT([&] { estimateSoil({.table = table.path(), .method = "wong-reece"}, {}); },
                ThrowsMessage<std::domain_error>(testing::AllOf(
                    HasSubstr(table.path() + ": no soil "),
                    HasSubstr("check unit, sign and sensor of column side_force_N, without which"))))
        << angle << ' ' << side;
  }
}

// Property: a small sensor offset of the side force of straight wheels moves the soil by less than a tenth of its
// standard deviation.
TEST(EstimateSoil, SmallSideForceOfStraightWheelsIsIgnored) {
  const test::TemporaryFile none{heldRows(0.0, 0.0)}, little{heldRows(0.0, 0.05)};
  const SoilEstimate without = estimateSoil({.table = none.path(), .method = "wong-reece"}, {});
  EXPECT_NEAR(estimateSoil({.table = little.path(), .method = "wong-reece"}, {}).cohesion_Pa,
              without.cohesion_Pa, 0.1 * std::sqrt(without.covariance(0, 0)));
}

TEST(EstimateSoil, UnknownMethodAndModulusNamesAreRejected) {
  const WheelTable table;
  EXPECT_THAT([&] { estimateSoil({.table = table.path(), .method = "wong-rece"}, {}); },
              ThrowsMessage<InputError>(HasSubstr("'wong-rece': is unknown; there are bevameter")));
  EXPECT_THAT(
      [&] { estimateSoil({.table = table.path(), .method = "iagnemma", .shear_modulus = "jointly"}, {}); },
      ThrowsMessage<InputError>(HasSubstr("'jointly': is unknown")));
}

}  // namespace soil_estimate_test

}  // namespace talus::terramech
