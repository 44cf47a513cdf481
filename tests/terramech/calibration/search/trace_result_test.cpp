#include <cmath>

#include <talus/terramech/calibration.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace trace_result_test {

TEST(TraceResult, ErrorsAreRootMeanSquaresPerChannel) {
  RefinedModel model;
  model.soil = madeSand();
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(1);
  for (int k = 0; k < 4; ++k) {
    std::vector<double> row = wheelRow(model.soil, 60.0 + 10.0 * k, 0.2 + 0.1 * k, 0.0, random);
    row[4] += (k % 2 ? 0.03 : -0.04) * row[0];  // pull
    if (k == 0) row[2] = std::nan("");          // torque, not measured
    rows.add(row);
  }
  const ChannelErrors errors = rmseOf(model, makeTrial(rows.telemetry(), model));
  // Closed form: sqrt((0.03^2 + 0.04^2) / 2) in drawbar pull over load, 0 in other channels; NaN for channels
  // without measurements.
  EXPECT_NEAR(errors[0], std::sqrt(0.00125), 1e-6);
  EXPECT_NEAR(errors[1], 0.0, 1e-6);
  EXPECT_NEAR(errors[2], 0.0, 1e-6);
  EXPECT_TRUE(std::isnan(errors[3]));
}

}  // namespace trace_result_test
}  // namespace talus::terramech
