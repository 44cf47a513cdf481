#include <cmath>
#include <limits>

#include <site_fixture.hpp>

#include <costmap/wheel_observation.hpp>
#include <terramech/wong_reece.hpp>

namespace talus::costmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What a wheel of the test rover reads on a soil at a slip, noise-free, on the slope on which it drives
// steadily.
WheelReading reading(const terramech::Soil& soil, double slip) {
  const terramech::Rover rover = testRover();
  const double load_N = terramech::wheelLoad_N(rover);
  const auto wheel = terramech::equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip});
  return {.time_s = 1.0,
          .place = {},
          .load_N = load_N,
          .slip = slip,
          .torque_Nm = wheel.torque_Nm,
          .sinkage_m = wheel.sinkage_m,
          .gradient = wheel.drawbar_pull_N / load_N,
          .drawbar_pull_N = kNone};
}

TEST(WheelObserver, GroundThatIsItsClassShowsNoDeparture) {
  const auto model = testGround();
  for (const double slip : {0.1, 0.3, 0.5}) {
    const auto seen = WheelObserver(*model).observe(0, reading(testSand(), slip));
    ASSERT_TRUE(seen.has_value());
    // Property: reading and class agree; Eq. 3.12 is good to 0.03, and the slope outweighs it.
    EXPECT_NEAR(seen->pull.mean, model->prior(0).pull.mean, 0.02) << slip;
    EXPECT_NEAR(seen->sinkage.mean, model->prior(0).sinkage.mean, 0.02) << slip;
  }
}

TEST(WheelObserver, SeesThatSandIsDust) {
  const auto model = testGround();
  for (const double slip : {0.3, 0.5}) {
    const auto seen = WheelObserver(*model).observe(0, reading(testDust(), slip));
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(seen->pull.mean, model->prior(1).pull.mean, 2.0 * seen->pull.std) << slip;
    EXPECT_LT(seen->pull.mean, model->prior(0).pull.mean - 2.0 * seen->pull.std) << slip;
  }
}

TEST(WheelObserver, SlipAndSlopeAloneTellEnough) {
  const auto model = testGround();
  WheelReading blind = reading(testDust(), 0.5);
  blind.torque_Nm = blind.sinkage_m = kNone;
  const auto seen = WheelObserver(*model).observe(0, blind);
  ASSERT_TRUE(seen.has_value());
  EXPECT_NEAR(seen->pull.mean, model->prior(1).pull.mean, 0.02);
  EXPECT_TRUE(std::isinf(seen->sinkage.std));
}

TEST(WheelObserver, NothingToGoByNothingSaid) {
  const auto model = testGround();
  WheelReading blind = reading(testSand(), 0.2);
  blind.torque_Nm = blind.sinkage_m = blind.gradient = kNone;
  EXPECT_FALSE(WheelObserver(*model).observe(0, blind).has_value());
  blind = reading(testSand(), 0.2);
  blind.slip = kNone;
  EXPECT_FALSE(WheelObserver(*model).observe(0, blind).has_value());
}

TEST(PullFromTorque, FlatWheelPullsItsTorque) {
  EXPECT_DOUBLE_EQ(pullFromTorque(0.4, 0.0), 0.4);  // Closed form: no sinkage, no resistance
}

}  // namespace
}  // namespace talus::costmap
