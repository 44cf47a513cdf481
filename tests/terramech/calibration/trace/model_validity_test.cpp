#include <cmath>

#include <talus/terramech/calibration/trace/model_validity.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "made_rows.hpp"

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
}  // namespace talus::terramech
