#include <cmath>

#include <talus/terramech/estimate/state_population.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace state_population_test {

const ReadingErrors kErrors = ReadingErrors::relative(0.05);

TEST(StatePopulation, FewSamplesLeaveReadingsUnchanged) {
  StatePopulation population;
  const WheelSample s{.load_N = 80.0, .torque_Nm = 3.0, .sinkage_m = 0.01, .slip = 0.4};
  for (int count = 0; count <= 3; ++count) {
    EXPECT_DOUBLE_EQ(population.load(s, kErrors).value, 80.0);
    EXPECT_NEAR(population.load(s, kErrors).std, 4.0, 1e-12);
    EXPECT_EQ(population.slip(s, kErrors).value, 0.4);
    EXPECT_NEAR(population.slip(s, kErrors).std, 0.02, 1e-15);
    population.add(s, kErrors);
  }
}

TEST(StatePopulation, ShrinksReadingsTowardsThePopulation) {
  // Closed form: with true ln W and slip Gaussian with known spread, and errors as stated, an error is
  // reduced by the factor sqrt(V / (V + s^2)), as is its standard deviation. 4000 readings determine the
  // spread to 2 %.
  constexpr int kCount = 4000;
  constexpr double kSpread = 0.08;  // standard deviation of ln W
  StatePopulation population;
  std::vector<double> truth;
  std::vector<WheelSample> readings;
  const Eigen::MatrixXd points = evenPoints(3, kCount);
  for (int k = 0; k < kCount; ++k) {
    truth.push_back(std::log(80.0) + kSpread * normalQuantile(points(0, k)));
    readings.push_back({.load_N = std::exp(truth.back() + 0.05 * normalQuantile(points(1, k))),
                        .torque_Nm = 3.0,
                        .sinkage_m = 0.01,
                        .slip = 0.4 + 0.02 * normalQuantile(points(2, k))});
    population.add(readings.back(), kErrors);
  }
  double squares = 0.0, stated = 0.0, slip_squares = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const Estimate load = population.load(readings[static_cast<std::size_t>(k)], kErrors);
    squares += std::pow(std::log(load.value) - truth[static_cast<std::size_t>(k)], 2) / kCount;
    stated += std::pow(load.std / load.value, 2) / kCount;
    slip_squares +=
        std::pow(population.slip(readings[static_cast<std::size_t>(k)], kErrors).value - 0.4, 2) / kCount;
  }
  const double share = kSpread * kSpread / (kSpread * kSpread + 0.05 * 0.05);
  EXPECT_NEAR(std::sqrt(squares), 0.05 * std::sqrt(share), 0.002);
  EXPECT_NEAR(std::sqrt(stated), 0.05 * std::sqrt(share), 0.002);
  EXPECT_LT(std::sqrt(slip_squares), 0.005);  // all rows have one slip and a reading error of 0.02
}

}  // namespace state_population_test
}  // namespace talus::terramech
