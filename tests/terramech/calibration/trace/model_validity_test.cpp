#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {

namespace model_validity_test {

Applicability judged(const Telemetry& telemetry) {
  const RefinedModel base = unknownSoil().model;
  TraceOptions options{.fit_soil = true};
  return applicability(traceResiduals(base, makeTrial(telemetry, base), options), options);
}

TEST(ModelValidity, SandIsApplicable) {
  const Soil sand{.name = "sand",
                  .cohesion_Pa = 500.0,
                  .friction_angle_rad = 0.55,
                  .sinkage_exponent = 1.0,
                  .frictional_modulus = 1.0e6,
                  .shear_modulus_m = 0.02};
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{2};
  for (int k = 0; k < 60; ++k)
    rows.add(wheelRow(sand, 20.0 + 15.0 * (k % 5), 0.05 + 0.014 * k, 0.03, random));
  const Applicability a = judged(rows.telemetry());
  EXPECT_TRUE(a.applies) << a.reason;
}

TEST(ModelValidity, SnowInconsistentWithMohrCoulombIsNotApplicable) {
  // Synthetic readings that resemble snow: the strength falls with slip, the sinkage is independent of the
  // load, and the pull exceeds the value possible with the torque.
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{3};
  std::normal_distribution<double> noise(1.0, 0.03);
  for (int k = 0; k < 80; ++k) {
    const double load = 100.0 + 40.0 * (k % 4), slip = 0.02 + 0.012 * k;
    rows.add({load, slip, (0.2 + 0.3 * std::exp(-slip / 0.15)) * load * 0.1 * noise(random),
              0.03 * noise(random), (0.75 * std::exp(-slip / 0.2) - 0.2) * load * noise(random), 0.1, 0.1});
  }
  const Applicability a = judged(rows.telemetry());
  EXPECT_FALSE(a.applies);
  EXPECT_FALSE(a.reason.empty());
}

TEST(ModelValidity, TorqueUnrelatedToSlipIsNotApplicable) {
  MadeRows rows({"load_N", "slip", "torque_Nm", "wheel_radius_m", "wheel_width_m"});
  std::mt19937_64 random{4};
  std::normal_distribution<double> scatter(0.0, 0.08);
  for (int k = 0; k < 120; ++k)
    rows.add({200.0, 0.05 + 0.0075 * k, 200.0 * 0.1 * (0.3 - 0.1 * (k % 2) + scatter(random)), 0.1, 0.1});
  EXPECT_FALSE(judged(rows.telemetry()).applies);
}

TEST(ModelValidity, ForcesOverALoadInKilogramsAreImpossible) {
  // Property: readings of the synthetic sand, with the load of a scale in kilograms.
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{2};
  for (int k = 0; k < 60; ++k) {
    std::vector<double> row = wheelRow(madeSand(), 40.0 + 15.0 * (k % 5), 0.05 + 0.014 * k, 0.03, random);
    row[0] /= 9.81;
    rows.add(row);
  }
  const Applicability a = judged(rows.telemetry());
  EXPECT_FALSE(a.applies);
  EXPECT_NE(a.reason.find("more than a wheel reaches on soil"), std::string::npos) << a.reason;
}

TEST(ModelValidity, ClosureRelationIsValidForAnySoil) {
  // Property: the relation has the stated accuracy relative to the integrated forces, over a grid of soils
  // and slips.
  std::mt19937_64 random{6};
  MadeRows rows(wheelColumns());
  for (const double friction : {0.35, 0.5, 0.65})
    for (const double cohesion : {0.0, 1000.0, 3000.0})
      for (const double slip : {0.1, 0.3, 0.6})
        rows.add(wheelRow({.name = "sand",
                           .cohesion_Pa = cohesion,
                           .friction_angle_rad = friction,
                           .sinkage_exponent = 1.0,
                           .frictional_modulus = 1.2e6,
                           .shear_modulus_m = 0.015},
                          50.0, slip, 0.0, random));
  for (const double error : closureErrors(makeTrial(rows.telemetry(), RefinedModel{})))
    EXPECT_LT(std::abs(error), 0.03);
}

}  // namespace model_validity_test

namespace scale_hypotheses_test {

/// The scale of a table of the synthetic sand with 2 % errors, whose column number `column` is multiplied by
/// `factor`. The soil is known within 10 %.
std::optional<ScaledColumn> scaleOf(std::size_t column, double factor) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  for (int k = 0; k < 80; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 40.0 + (k * 7) % 80, 0.05 + 0.05 * ((k * 11) % 12), 0.02, random);
    row[column] *= factor;
    rows.add(row);
  }
  RefinedModel base;
  base.soil = madeSand();
  for (const auto& [name, mean] : {std::pair{"friction_angle_rad", base.soil.friction_angle_rad},
                                   {"frictional_modulus", base.soil.frictional_modulus}}) {
    base.soil_prior_mean[name] = mean;
    base.soil_prior_std[name] = 0.1 * mean;
  }
  const TraceResult result = traceResiduals(base, makeTrial(rows.telemetry(), base), {.max_effects = 0});
  return likelyScale(result, result.base, {});
}

TEST(ScaleHypotheses, ColumnInAnotherUnitIsNamedWithItsScale) {
  // Property: the table was multiplied by the inverse of the scale that is found.
  for (const auto& [column, name, scale] :
       {std::tuple{0U, "load_N", 9.81}, {2U, "torque_Nm", 0.5}, {4U, "drawbar_pull_N", 9.81}}) {
    const auto found = scaleOf(column, 1.0 / scale);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->column, name);
    EXPECT_EQ(found->scale, scale);
  }
  EXPECT_EQ(scaleOf(0, 1.0 / 9.81)->text().substr(0, 42), "load_N looks like kilograms: scale 9.81 (l");
}

TEST(ScaleHypotheses, SoundTableHasNoScale) {
  EXPECT_FALSE(scaleOf(0, 1.0));
}

}  // namespace scale_hypotheses_test

namespace table_applicability_test {

/// A table of 60 rows: readings of a wheel on sand or, if shuffled, readings that no soil explains.
std::string tableOf(bool shuffled) {
  RefinedModel sand;
  sand.soil = {.cohesion_Pa = 800.0,
               .friction_angle_rad = 0.55,
               .sinkage_exponent = 1.0,
               .cohesive_modulus = 0.0,
               .frictional_modulus = 1e6,
               .shear_modulus_m = 0.015};
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::string text = "load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m\n";
  for (int k = 0; k < 60; ++k) {
    const WheelState s{.wheel = {.radius_m = 0.1, .width_m = 0.1},
                       .load_N = 50.0 + 5.0 * (k % 8),
                       .slip = 0.05 + 0.01 * (k % 50)};
    const Reading r = predict(sand, s);
    const double noise = 1.0 + 0.02 * normal(random);
    const double torque = shuffled ? std::abs(4.0 + 3.0 * normal(random)) : r.torque_Nm * noise;
    const double sinkage = shuffled ? std::abs(0.03 + 0.02 * normal(random)) : r.sinkage_m * noise;
    const double pull = shuffled ? 20.0 * normal(random) : r.drawbar_pull_N;
    for (const double v : {s.load_N, s.slip, torque, sinkage, pull, 0.1}) text += std::to_string(v) + ",";
    text += "0.1\n";
  }
  return text;
}

TEST(TableApplicability, ModelAppliesToWheelDataAndNotToOtherData) {
  const test::TemporaryFile sand{tableOf(false)}, other{tableOf(true)};
  EXPECT_TRUE(tableApplicability(sand.path(), "", "").applies);
  const Applicability none = tableApplicability(other.path(), "", "");
  EXPECT_FALSE(none.applies);
  EXPECT_FALSE(none.reason.empty());
}

TEST(TableApplicability, TableWithTooLittleDataIsAssumedApplicable) {
  const test::TemporaryFile few{"load_N,slip,sinkage_m,wheel_radius_m,wheel_width_m\n50,0.2,0.01,0.1,0.1\n"};
  EXPECT_TRUE(tableApplicability(few.path(), "", "").applies);
  const test::TemporaryFile bare{"slip,sinkage_m\n0.2,0.01\n"};
  EXPECT_TRUE(tableApplicability(bare.path(), "", "").applies);
}

}  // namespace table_applicability_test

}  // namespace talus::terramech
