#include <cmath>
#include <numeric>

#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::terramech {
namespace load_transfer_test {

Rover rover() {
  Rover r;
  r.mass_kg = 100.0;
  r.gravity_m_s2 = 10.0;
  r.wheel_count = 4;
  r.wheelbase_m = 1.0;
  r.centre_of_mass_height_m = 0.5;
  return r;
}

TEST(WheelLoads, LoadsAreEqualOnLevelGround) {
  for (const double load_N : wheelLoads_N(rover(), 0.0, {0.5, 0.5, -0.5, -0.5}))
    EXPECT_DOUBLE_EQ(load_N, 250.0);
}

TEST(WheelLoads, TwoAxleLoadTransferMatchesClosedForm) {
  const double slope = 0.2;
  const auto loads_N = wheelLoads_N(rover(), std::tan(slope), {0.5, 0.5, -0.5, -0.5});
  // Closed form: an axle loses m g sin(alpha) h / L, half of it at each wheel
  EXPECT_NEAR(loads_N[0], 250.0 * std::cos(slope) - 0.5 * 1000.0 * std::sin(slope) * 0.5 / 1.0, 1e-9);
  EXPECT_NEAR(loads_N[3], 250.0 * std::cos(slope) + 0.5 * 1000.0 * std::sin(slope) * 0.5 / 1.0, 1e-9);
}

TEST(WheelLoads, SixWheelLoadsBalanceForceAndMoment) {
  const double gradient = -0.15, normal_N = 1000.0 / std::hypot(1.0, gradient);
  const std::vector<double> along{0.5, 0.5, 0.1, 0.1, -0.6, -0.6};
  const auto loads_N = wheelLoads_N(rover(), gradient, along);
  double moment = 0.0;
  for (std::size_t w = 0; w < along.size(); ++w) moment += loads_N[w] * along[w];
  EXPECT_NEAR(std::accumulate(loads_N.begin(), loads_N.end(), 0.0), normal_N, 1e-9);
  EXPECT_NEAR(moment, -normal_N * gradient * 0.5, 1e-9);
}

TEST(WheelLoads, LoadsStayPositiveOnSteepSlopes) {
  for (const double load_N : wheelLoads_N(rover(), 2.0, {0.5, 0.5, -0.5, -0.5})) EXPECT_GT(load_N, 0.0);
  EXPECT_TRUE(wheelLoads_N(rover(), 0.1, {}).empty());
  EXPECT_EQ(wheelLoads_N(rover(), 0.1, {0.0}).size(), 1U);
}

}  // namespace load_transfer_test
}  // namespace talus::terramech
