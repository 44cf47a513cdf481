#include <cmath>

#include <talus/terramech/calibration/noise/noise_floor.hpp>

#include "calibration/slip_rows.hpp"

namespace talus::terramech {
namespace noise_floor_test {

// Closed form: independent errors add in squares. Rows of load 50 N at slip 0.3, drawbar pull over load 0.2
// in every second row. Errors: 1 N of the load cell is 0.02, 10 % of the reading 0.02, a slip error of 3 % of
// 0.3 times a slope of 1 is 0.009, 2 % of the load times 0.5 is 0.01.
TEST(NoiseFloor, ErrorsAddInSquares) {
  Trial trial = trialOf(std::vector<double>(8, 0.3));
  trial.measured.setConstant(std::nan(""));
  for (int row = 0; row < 8; row += 2) trial.measured(row, 0) = 0.4;
  const Eigen::MatrixXd level = Eigen::MatrixXd::Constant(8, kChannels, 0.2);
  const InputSlopes slopes{Eigen::MatrixXd::Constant(8, kChannels, 1.0),
                           Eigen::MatrixXd::Constant(8, kChannels, 0.5)};
  SensorNoise noise = slipNoise(0.03);
  noise.absolute.fill(1.0);
  noise.relative.fill(0.1);
  noise.slip_absolute = 0.0;
  const auto floor = noiseFloor(trial, level, slopes, noise);
  EXPECT_NEAR(floor[0], std::sqrt(2.0 * 0.02 * 0.02 + 0.009 * 0.009 + 0.01 * 0.01), 1e-12);
  for (std::size_t c = 1; c < kChannels; ++c) EXPECT_TRUE(std::isnan(floor[c])) << c;
}

}  // namespace noise_floor_test
}  // namespace talus::terramech
