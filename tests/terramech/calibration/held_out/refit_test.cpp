#include <talus/terramech/calibration/held_out/refit.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace refit_test {

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

}  // namespace refit_test
}  // namespace talus::terramech
