#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/held_out/model_scope.hpp>

#include "calibration/traced_world.hpp"
#include "made_rows.hpp"

namespace talus::terramech {
namespace held_out_test {

TEST(HeldOut, HeldOutErrorIsReducedOnHiddenLibraryEffect) {
  const blind::World world = blind::makeWorld({.seed = 10, .effects = 1, .library = true});
  const TraceResult result = traced(world);
  const HeldOut& held = result.held_out;
  EXPECT_FALSE(held.scheme.empty());
  EXPECT_LT(held.refined_rmse[1], held.base_rmse[1]);
}

/// Runs of constant moisture, which reduces the pull in proportion to slip: not a form of the library. The
/// standard deviation of the soil is 10 %, and the sensor errors are stated.
TraceResult moistRuns(unsigned seed) {
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("moisture_pct");
  MadeRows rows(columns);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> moistures(1.0, 9.0);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 12; ++run) {
    const double moisture = moistures(random);
    for (int k = 0; k < 12; ++k) {
      const double load = 50.0 + 30.0 * (run % 3), slip = 0.02 + 0.055 * k;
      std::vector<double> row = wheelRow(madeSand(), load, slip, 0.0, random);
      row[2] += 0.15 * normal(random);
      row[3] += 0.001 * normal(random);
      row[4] += 0.57 * normal(random) - 0.048 * moisture * slip * load;
      row.push_back(moisture);
      rows.add(row, "run" + std::to_string(run));
    }
  }
  RefinedModel base;
  base.soil = madeSand();
  base.soil.friction_angle_rad *= 0.965;
  base.soil.frictional_modulus *= 1.19;
  base.soil.shear_modulus_m *= 0.84;
  for (const auto& [name, mean] : std::initializer_list<std::pair<const char*, double>>{
           {"cohesion_Pa", base.soil.cohesion_Pa},
           {"friction_angle_rad", base.soil.friction_angle_rad},
           {"sinkage_exponent", base.soil.sinkage_exponent},
           {"frictional_modulus", base.soil.frictional_modulus},
           {"shear_modulus_m", base.soil.shear_modulus_m}}) {
    base.soil_prior_mean[name] = mean;
    base.soil_prior_std[name] = 0.1 * mean;
  }
  base.stated = {.load_N = 1.6, .slip = 0.01, .torque_Nm = 0.15, .sinkage_m = 0.001, .drawbar_pull_N = 0.57};
  TraceOptions options;
  return traceResiduals(base, makeTrial(rows.telemetry("run"), base), options);
}

TEST(HeldOut, ReportedErrorIsThatOfPredictions) {
  for (const unsigned seed : {1U, 5U}) {
    const TraceResult result = moistRuns(seed);
    ASSERT_FALSE(result.effects.empty());
    const Trial rows = asMeasured(result.trial);
    const ChannelErrors predicted = rmseOf(predictInScope(result, rows), rows);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(result.refined_rmse[c], predicted[c]) << seed;
  }
}

TEST(SquaredErrors, AreRootMeanSquaresByChannelWithoutNaN) {
  // Closed form: residuals 3 and 4 have the mean square 12.5; a channel without values has NaN.
  Eigen::MatrixXd residual = Eigen::MatrixXd::Constant(2, kChannels, std::nan(""));
  residual(0, 0) = 3.0;
  residual(1, 0) = 4.0;
  residual(1, 2) = -2.0;
  SquaredErrors errors;
  errors.add(residual);
  EXPECT_DOUBLE_EQ(errors.rmse()[0], std::sqrt(12.5));
  EXPECT_TRUE(std::isnan(errors.rmse()[1]));
  EXPECT_DOUBLE_EQ(errors.rmse()[2], 2.0);
}

TEST(RefittedBase, KeepsRunOffsetsOutOfTheSoilFit) {
  // Property: pull offsets of runs do not change the soil if modelled as shared errors; as errors of single
  // rows they change the soil.
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(7);
  TraceResult result;
  for (int run = 0; run < 10; ++run)
    for (int k = 0; k < 8; ++k) {
      std::vector<double> row = wheelRow(madeSand(), 60.0 + 5.0 * k, 0.05 + 0.06 * run, 0.01, random);
      row[4] -= 0.025 * run * row[0];
      rows.add(row);
      result.base_shared.unit.push_back(run);
    }
  result.base.soil = madeSand();
  result.base.noise.absolute = {0.8, 0.0005, 0.1, 0.0};
  result.base_shared.run(0, 0) = 0.1 * 0.1;
  result.trial = makeTrial(rows.telemetry(), result.base);
  const std::vector<char> all(80, 1);
  TraceOptions options;
  options.fit_soil = true;
  const double sinkage = rmseAsMeasured(refittedBase(result, options, all), result.trial)[1];
  EXPECT_LT(sinkage, 0.01);
  result.base_shared = {};
  EXPECT_GT(rmseAsMeasured(refittedBase(result, options, all), result.trial)[1], 3.0 * sinkage);
}

}  // namespace held_out_test
}  // namespace talus::terramech
