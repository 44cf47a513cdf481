// Tests of the bounds from each channel of one reading.
#include <cmath>
#include <limits>
#include <random>

#include <site_map.hpp>

#include <talus/costmap/telemetry/danger_watch.hpp>

namespace talus::costmap {
namespace danger_watch_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TelemetryReading level(double slip, double sinkage_over_radius, double torque_Nm = kNone) {
  return {.place = {},
          .load_N = terramech::wheelLoad_N(testRover()),
          .slip = slip,
          .torque_Nm = torque_Nm,
          .sinkage_m = sinkage_over_radius * testRover().wheel.radius_m,
          .drawbar_pull_N = kNone};
}

TEST(DangerWatch, OrdinaryReadingsYieldNoBound) {
  const auto model = testGround();
  for (const double slip : {-1.0, -0.2, 0.3, 0.69, kNone, -kInfinite})
    for (const double z : {0.0, 0.49, kNone})
      EXPECT_FALSE(DangerWatch(*model).bound(0, level(slip, z), 0.0).any());
}

// Closed form: ground whose pull is below tan(slope - margin) is dangerous on that slope.
TEST(DangerWatch, EachChannelBoundsIndependently) {
  const auto model = testGround();
  const DangerWatch watch(*model);
  const double margin = model->parts().policy.slope_margin_rad;
  const double level_limit = std::tan(-margin);
  const double never = std::tan(-model->rover().max_pitch_rad - margin);
  EXPECT_LT(watch.bound(0, level(0.85, kNone), 0.0).most_pull, level_limit);
  EXPECT_LT(watch.bound(0, level(0.1, kNone, 99.0), 0.0).most_pull, level_limit);
  EXPECT_LT(watch.bound(0, level(0.1, kNone, kInfinite), 0.0).most_pull, level_limit);
  for (const TelemetryReading& held :
       {level(0.93, kNone), level(kInfinite, kNone), level(1.2, 0.0), level(0.1, 0.8), level(kNone, 0.8),
        level(0.1, 2.3), level(0.1, kInfinite)})
    EXPECT_LT(watch.bound(0, held, 0.3).most_pull, never) << held.slip << ' ' << held.sinkage_m;
  TelemetryReading spinning = level(kNone, kNone);
  spinning.speed_slip = 0.95;
  EXPECT_LT(watch.bound(0, spinning, 0.3).most_pull, never);
  const GroundBound deep = watch.bound(0, level(0.1, 0.6), 0.0);
  EXPECT_TRUE(std::isnan(deep.most_pull));
  EXPECT_NEAR(deep.least_sinkage, 0.6, 1e-12);
  // The torque is at the limit of the motor, in the braking direction.
  EXPECT_LT(watch.bound(0, level(0.1, kNone, -99.0), 0.0).most_pull, level_limit);
}

// Closed form: at(slip) is the pull of the class at the slip. The deficit is at(slip) minus the gradient
// minus 0.05 (two standard deviations). In a rut, at(slip) is the pull of the class in a rut.
TEST(DangerWatch, SlipFrom70PercentBoundsThePull) {
  const auto model = testGround();
  const DangerWatch watch(*model);
  for (const double slip : {0.7, 0.72, 0.79})
    for (const int pass : {1, 3}) {
      TelemetryReading reading = level(slip, kNone);
      reading.pass = pass;
      const double at = model->steady(0, {.slip = slip, .in_rut = pass > 1}).gradient;
      EXPECT_NEAR(watch.bound(0, reading, 0.1).most_pull, model->prior(0).pull.value + 0.1 - at + 0.05,
                  1e-12);
    }
  EXPECT_NE(model->steady(0, {.slip = 0.72, .in_rut = true}).gradient,
            model->steady(0, {.slip = 0.72, .in_rut = false}).gradient);
}

// Closed form: two standard deviations of reading and class combined.
TEST(DangerWatch, SuspectedPullFarBelowTheClassBounds) {
  const auto model = testGround();
  const double prior = model->prior(0).pull.value, class_std = model->parts().classes[0].pull_std;
  const double far = 2.0 * std::hypot(0.05, class_std);
  const auto bound = [&](double pull) {
    WheelObservation suspected{.place = {}, .pull = {pull, 0.05}, .sinkage = {}};
    return DangerWatch(*model).bound(0, suspected).most_pull;
  };
  EXPECT_TRUE(std::isnan(bound(prior + 1.0)));
  EXPECT_TRUE(std::isnan(bound(prior - far + 1e-6)));
  EXPECT_EQ(bound(prior - far - 1e-6), prior - far - 1e-6);
  EXPECT_EQ(bound(-1e14), -10.0);
  EXPECT_TRUE(std::isnan(bound(kNone)));
}

// Property: more slip, more sinkage or a lower slope never loosens a bound.
TEST(DangerWatch, BoundsAreMonotoneInSlipSinkageAndSlope) {
  const auto model = testGround();
  const DangerWatch watch(*model);
  const auto most = [](const GroundBound& b) { return std::isnan(b.most_pull) ? 9.0 : b.most_pull; };
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double slip = 1.2 * share(random), z = 1.2 * share(random), gradient = share(random) - 0.5;
    const double before = most(watch.bound(i % 2, level(slip, z), gradient));
    EXPECT_LE(most(watch.bound(i % 2, level(slip + 0.1 * share(random), z), gradient)), before + 1e-9);
    EXPECT_LE(most(watch.bound(i % 2, level(slip, z + 0.1 * share(random)), gradient)), before + 1e-9);
    EXPECT_LE(most(watch.bound(i % 2, level(slip, z), gradient - 0.1 * share(random))), before + 1e-9);
  }
}

// Telemetry of one wheel or several; a column that is NaN in every row is left out.

}  // namespace danger_watch_test
}  // namespace talus::costmap
