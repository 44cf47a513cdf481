#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <site_fixture.hpp>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/evidence/observation_fault.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::costmap {

namespace wheel_observation_test {

constexpr double kInf = std::numeric_limits<double>::infinity();

WheelObservation possible() {
  return {.place = {}, .pull = {0.1, 0.05}, .sinkage = {0.2, kInf}};
}

TEST(ObservationFault, ImpossibleObservationsNameTheField) {
  using O = WheelObservation;
  struct Case {
    std::function<void(O&)> change;
    const char* named;
  };
  EXPECT_EQ(fault(possible()), "");
  for (const Case& c :
       std::vector<Case>{{[](O& o) { o.pull.value = kInf; }, "pull = inf, must be finite and within 100"},
                         {[](O& o) { o.pull.value = std::nan(""); }, "pull = nan"},
                         {[](O& o) { o.pull.value = 1e300; }, "pull = "},
                         {[](O& o) { o.sinkage.value = std::nan(""); }, "sinkage = nan"},
                         {[](O& o) { o.pull.std = -1.0; }, "standard deviation"},
                         {[](O& o) { o.pull.std = std::nan(""); }, "pull_std = nan"},
                         {[](O& o) { o.place.x_m = kInf; }, "x_m = inf"},
                         {[](O& o) { o.place.y_m = std::nan(""); }, "y_m = nan"},
                         {[](O& o) { o.pose_std_m = kInf; }, "pose_std_m = inf"},
                         {[](O& o) { o.here.most_pull = kInf; }, "a bound"},
                         {[](O& o) { o.here.most_pull = 101.0; }, "a bound"},
                         {[](O& o) { o.here.least_sinkage = -0.1; }, "a bound"},
                         {[](O& o) { o.shared_std = kInf; }, "standard deviation"},
                         {[](O& o) { o.share = kInf; }, "share of the thrust"}}) {
    WheelObservation observation = possible();
    c.change(observation);
    EXPECT_NE(fault(observation).find(c.named), std::string::npos) << c.named << ": " << fault(observation);
  }
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Noise-free reading of a wheel of the test rover on a soil at a slip, on the slope of steady driving.
TelemetryReading reading(const terramech::Soil& soil, double slip) {
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

TEST(WheelObserver, MatchingGroundShowsNoDeparture) {
  const auto model = testGround();
  for (const double slip : {0.1, 0.3, 0.5}) {
    const auto seen = WheelObserver(*model).observe(0, reading(testSand(), slip));
    ASSERT_TRUE(seen.has_value());
    // Property: the estimate equals the class value. Tolerance: Eq. 3.12, accurate to 0.03, has less weight
    // than the slope.
    EXPECT_NEAR(seen->pull.value, model->prior(0).pull.value, 0.02) << slip;
    EXPECT_NEAR(seen->sinkage.value, model->prior(0).sinkage.value, 0.02) << slip;
  }
}

TEST(WheelObserver, SandClassOnDustIsObservedAsDust) {
  const auto model = testGround();
  for (const double slip : {0.3, 0.5}) {
    const auto seen = WheelObserver(*model).observe(0, reading(testDust(), slip));
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(seen->pull.value, model->prior(1).pull.value, 2.0 * seen->pull.std) << slip;
    EXPECT_LT(seen->pull.value, model->prior(0).pull.value - 2.0 * seen->pull.std) << slip;
  }
}

TEST(WheelObserver, SlipAndSlopeSufficeForAPullObservation) {
  const auto model = testGround();
  TelemetryReading blind = reading(testDust(), 0.5);
  blind.torque_Nm = blind.sinkage_m = kNone;
  const auto seen = WheelObserver(*model).observe(0, blind);
  ASSERT_TRUE(seen.has_value());
  EXPECT_NEAR(seen->pull.value, model->prior(1).pull.value, 0.02);
  EXPECT_TRUE(std::isinf(seen->sinkage.std));
}

TEST(WheelObserver, InsufficientReadingsYieldNoObservation) {
  const auto model = testGround();
  TelemetryReading blind = reading(testSand(), 0.2);
  blind.torque_Nm = blind.sinkage_m = blind.gradient = kNone;
  EXPECT_FALSE(WheelObserver(*model).observe(0, blind).has_value());
  blind = reading(testSand(), 0.2);
  blind.slip = kNone;
  EXPECT_FALSE(WheelObserver(*model).observe(0, blind).has_value());
}

// Readings of two wheels on one soil and two on another at one slip, on the slope of their joint
// equilibrium.
std::vector<ClassReading> halfAndHalf(const terramech::Soil& front, const terramech::Soil& rear,
                                      double slip) {
  std::vector<ClassReading> all{{0, reading(front, slip)},
                                {0, reading(front, slip)},
                                {0, reading(rear, slip)},
                                {0, reading(rear, slip)}};
  const double gradient = 0.5 * (all[0].reading.gradient + all[2].reading.gradient);
  for (ClassReading& r : all) r.reading.gradient = gradient;
  return all;
}

TEST(WheelObserver, WheelsOnDifferentGroundAreDistinguished) {
  const auto model = testGround();
  for (const double slip : {0.2, 0.4, 0.7}) {
    const auto seen = WheelObserver(*model).observe(halfAndHalf(testDust(), testSand(), slip));
    const double sand = model->prior(0).pull.value, dust = model->prior(1).pull.value;
    EXPECT_LT(seen[0]->pull.value, sand - 0.45 * (sand - dust)) << slip;
    EXPECT_NEAR(seen[3]->pull.value, sand, 2.0 * seen[3]->pull.std) << slip;
    EXPECT_GT(seen[3]->pull.value, seen[0]->pull.value + 0.1) << slip;
  }
}

TEST(WheelObserver, DeepSinkageAtLowSlipIndicatesWeakerGround) {
  const auto model = testGround();
  const auto seen = WheelObserver(*model).observe(halfAndHalf(testDust(), testSand(), 0.05));
  // Property: the estimate is lower by more than the variation of the class between places
  EXPECT_LT(seen[0]->pull.value, model->prior(0).pull.value - 0.05);
}

TEST(WheelObserver, RutIsNotInterpretedAsFirmGround) {
  const auto model = testGround();
  std::vector<ClassReading> all = halfAndHalf(testSand(), terramech::rutted(testSand()), 0.3);
  all[2].reading.pass = all[3].reading.pass = 2;
  const auto told = WheelObserver(*model).observe(all);
  for (const auto& seen : told) EXPECT_NEAR(seen->pull.value, model->prior(0).pull.value, 0.03);
  EXPECT_GT(told[2]->pull.std, told[0]->pull.std) << "a rut says less about fresh ground";
  EXPECT_TRUE(std::isinf(told[2]->sinkage.std)) << "and nothing about its depth";
  all[2].reading.pass = all[3].reading.pass = 1;
  EXPECT_GT(WheelObserver(*model).observe(all)[2]->pull.value, model->prior(0).pull.value + 0.05);
}

TEST(WheelObserver, SpinningWheelIndicatesWeakGround) {
  const auto model = testGround();
  TelemetryReading spun = reading(testDust(), 0.98);
  spun.gradient = kNone;
  const auto seen = WheelObserver(*model).observe(0, spun);
  EXPECT_NEAR(seen->pull.value, model->prior(1).pull.value, 0.1);
}

TEST(PullFromTorque, PullEqualsTorqueAtZeroSinkage) {
  EXPECT_DOUBLE_EQ(pullFromTorque(0.4, 0.0), 0.4);  // Closed form: no sinkage, no resistance
}

// Reading of a wheel turned uphill by a slip angle, on the slope and cross slope of its equilibrium.
TelemetryReading crabbing(const terramech::Soil& soil, double slip, double slip_angle_rad) {
  const terramech::Rover rover = testRover();
  const double load_N = terramech::wheelLoad_N(rover);
  const auto wheel = terramech::equilibrium(
      soil, rover.wheel,
      {.load_N = load_N, .slip = slip, .slip_angle_rad = slip_angle_rad, .gravity_m_s2 = rover.gravity_m_s2});
  const double c = std::cos(slip_angle_rad), s = std::sin(slip_angle_rad);
  return {.time_s = 1.0,
          .place = {},
          .load_N = load_N,
          .slip = slip,
          .torque_Nm = wheel.torque_Nm,
          .sinkage_m = wheel.sinkage_m,
          .gradient = (wheel.drawbar_pull_N * c + wheel.side_force_N * s) / load_N,
          .across = (wheel.side_force_N * c - wheel.drawbar_pull_N * s) / load_N,
          .slip_angle_rad = slip_angle_rad,
          .drawbar_pull_N = kNone};
}

TEST(WheelObserver, SlipAngleDoesNotBiasTheObservation) {
  const auto model = testGround();
  const WheelObserver observer(*model);
  const double sand = model->prior(0).pull.value;
  for (const double slip : {0.15, 0.3, 0.5})
    for (const double angle : {-0.5, -0.25, -0.1, 0.1, 0.25, 0.5}) {
      const TelemetryReading on_sand = crabbing(testSand(), slip, angle);
      EXPECT_EQ(on_sand.across > 0.0, angle < 0.0);
      const auto same = observer.observe(0, on_sand);
      ASSERT_TRUE(same);
      // Property: the estimate equals the class value, as for straight wheels; the table of forces is
      // accurate to 0.015.
      EXPECT_NEAR(same->pull.value, sand, 0.03) << slip << ' ' << angle;
      // Property: weaker ground is estimated as weaker, at any combination of pull and side force.
      const auto weaker = observer.observe(0, crabbing(testDust(), slip, angle));
      ASSERT_TRUE(weaker);
      EXPECT_LT(weaker->pull.value, sand - 2.0 * weaker->pull.std) << slip << ' ' << angle;
      // Property: an unknown slip angle or cross slope yields a lower estimate.
      for (const bool angle_known : {false, true}) {
        TelemetryReading less = on_sand;
        (angle_known ? less.across : less.slip_angle_rad) = kNone;
        const auto seen = observer.observe(0, less);
        ASSERT_TRUE(seen);
        EXPECT_LE(seen->pull.value, same->pull.value + 0.01) << slip << ' ' << angle;
      }
    }
}

// Property: a low side force lowers the estimate of ground with the pull of its class.
TEST(WheelObserver, LowSideForceIndicatesWeakerGround) {
  const auto model = testGround();
  const WheelObserver observer(*model);
  TelemetryReading sliding = crabbing(testSand(), 0.3, -0.4);
  const double along = sliding.gradient, across = sliding.across, held = 0.4;
  // The pull in the wheel's plane is unchanged; the side force is reduced to the share `held`.
  const double c = std::cos(0.4), s = std::sin(0.4), pull = along * c + across * s,
               side = across * c - along * s;
  sliding.gradient = pull * c - held * side * s;
  sliding.across = held * side * c + pull * s;
  sliding.torque_Nm = sliding.sinkage_m = kNone;
  const auto seen = observer.observe(0, sliding);
  ASSERT_TRUE(seen);
  EXPECT_LT(seen->pull.value, model->prior(0).pull.value - 0.1);
  sliding.gradient = along;
  sliding.across = across;
  EXPECT_NEAR(observer.observe(0, sliding)->pull.value, model->prior(0).pull.value, 0.03);
}

// Property: from slip 0.9 on, the estimate from the force balance is limited to the class; a lower estimate
// is unchanged.
TEST(WheelObserver, HighSlipYieldsAnUpperBound) {
  const auto ground = testGround();
  const WheelObserver observer(*ground);
  const double prior = ground->prior(0).pull.value;
  for (const double slip : {0.9, 0.98})
    for (const double gradient : {-0.1, 0.0, 0.2, 0.4, 0.6}) {
      const auto seen = observer.observe(0, {.load_N = 55.0,
                                             .slip = slip,
                                             .torque_Nm = std::nan(""),
                                             .sinkage_m = std::nan(""),
                                             .gradient = gradient,
                                             .drawbar_pull_N = std::nan("")});
      ASSERT_TRUE(seen);
      EXPECT_LE(seen->pull.value, prior);
      const double departure = gradient - ground->steady(0, {slip, false}).drawbar_pull_over_load;
      // Closed form: P(i) + D f(i) = g, with f from the slope, but for what a slip error of 0.03 does not explain
      const auto share = [&](const SteadyWheel& wheel) {
        return wheel.torque_over_load_radius / ground->reference(0, false).torque_over_load_radius;
      };
      const double there = share(ground->onSlope(0, gradient, false)),
                   beyond = share(ground->steady(0, {slip, false})) - there,
                   error = 0.5 * (share(ground->steady(0, {slip + 0.03, false})) -
                                  share(ground->steady(0, {slip - 0.03, false}))),
                   f = beyond != 0.0 ? there + beyond * beyond * beyond / (beyond * beyond + error * error)
                                     : there;
      EXPECT_NEAR(seen->pull.value, prior + std::min(departure / f, 0.0), 1e-9);
    }
}

}  // namespace wheel_observation_test

}  // namespace talus::costmap
