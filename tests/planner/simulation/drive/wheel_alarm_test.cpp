#include <cmath>

#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {
namespace wheel_alarm_test {

constexpr double kRadius_m = 0.1;

// Six wheels; the middle and rear wheels run in ruts.
WheelMeasurements quiet() {
  WheelMeasurements look;
  for (int w = 0; w < 6; ++w) look.wheels.push_back({.slip = 0.1, .sinkage_m = 0.01, .pass = w / 2 + 1});
  return look;
}

const std::vector<WheelExpectation> kExpected(6, {.slip = 0.1, .sinkage_over_radius = 0.1});

TEST(WheelAlarm, ExpectedReadingsRaiseNoAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  for (int k = 0; k < 200; ++k) EXPECT_FALSE(alarm.check(quiet(), kExpected).reason);
}

TEST(WheelAlarm, SingleSlipSensorNeitherTriggersNorSuppressesTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements one = quiet();
  one.wheels[2].slip = 0.9;
  EXPECT_FALSE(alarm.check(one, kExpected).reason);
  WheelMeasurements all = quiet();
  for (auto& wheel : all.wheels) wheel.slip = 0.9;
  all.wheels[4].slip = 0.1;
  all.wheels[5].slip = std::nan("");
  EXPECT_EQ(alarm.check(all, kExpected).reason, "slips");
}

TEST(WheelAlarm, SlipAngleAboveExpectationTriggersTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements look = quiet();
  look.slip_angle_rad = -0.2;
  EXPECT_EQ(alarm.check(look, kExpected).reason, "slides");
  std::vector<WheelExpectation> slope = kExpected;
  for (auto& wheel : slope) wheel.slip_angle_rad = 0.1;
  EXPECT_FALSE(alarm.check(look, slope).reason);
  slope.assign(6, {.slip = 0.1, .sinkage_over_radius = 0.1, .slip_angle_rad = std::nan("")});
  EXPECT_EQ(alarm.check(look, slope).reason, "slides");  // unknown angle: compared with level ground
}

// Property: less braking than expected downhill is no alarm; a sensor stuck at its level-ground value would
// otherwise stop the rover.
TEST(WheelAlarm, LowSlipDownhillIsNoAlarm) {
  const std::vector<WheelExpectation> downhill(6, {.slip = -0.2, .sinkage_over_radius = 0.1});
  WheelAlarm alarm({}, kRadius_m);
  EXPECT_FALSE(alarm.check(quiet(), downhill).reason);
  WheelMeasurements slipping = quiet();
  for (auto& wheel : slipping.wheels) wheel.slip = 0.21;
  EXPECT_EQ(alarm.check(slipping, downhill).reason, "slips");
  EXPECT_FALSE(alarm.check(slipping, kExpected).reason);
}

TEST(WheelAlarm, SinkageOfOneWheelTriggersTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements look = quiet();
  look.wheels[1].sinkage_m = 0.02;
  const WheelAlarm::AlarmCheck check = alarm.check(look, kExpected);
  EXPECT_EQ(check.reason, "sinks");
  EXPECT_EQ(check.sank, (std::vector<bool>{false, true, false, false, false, false}));
  look.wheels[1].pass = 2;  // a rut of another wheel gives no evidence on fresh ground
  EXPECT_FALSE(alarm.check(look, kExpected).reason);
}

TEST(WheelAlarm, ConstantSinkageOffsetIsRemovedAndAJumpTriggersTheAlarm) {
  for (const double datum_m : {0.007, -0.007}) {
    WheelAlarm alarm({}, kRadius_m);
    WheelMeasurements look = quiet();
    look.wheels[0].sinkage_m += datum_m;
    for (int k = 0; k < 50; ++k) EXPECT_FALSE(alarm.check(look, kExpected).reason) << datum_m;
    look.wheels[0].sinkage_m += 0.009;
    EXPECT_EQ(alarm.check(look, kExpected).reason, "sinks") << datum_m;
  }
}

}  // namespace wheel_alarm_test
}  // namespace talus::planner
