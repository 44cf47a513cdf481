#include <cmath>
#include <string>

#include <site_fixture.hpp>

#include <talus/costmap/telemetry/sensor_watch.hpp>

namespace talus::costmap {
namespace sensor_watch_test {

TelemetryReading at(double time_s, double slip) {
  return {.time_s = time_s,
          .place = {},
          .load_N = 50.0,
          .slip = slip,
          .torque_Nm = 1.0 + 0.01 * slip,
          .sinkage_m = 0.01};
}

TEST(SensorWatch, QuietDriveIsAccepted) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3))).has_value());
  EXPECT_TRUE(watch.findings().empty());
}

TEST(SensorWatch, StuckValuesAndSpikesAreRejected) {
  const auto model = testGround();
  SensorWatch watch(*model, {.stuck_rows = 8});
  for (int i = 0; i < 10; ++i) watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3)));
  EXPECT_EQ(watch.refuse("w", at(2.0, 0.9)).value_or(""), "spike");
  EXPECT_FALSE(watch.refuse("w", at(2.1, 0.12)).has_value()) << "one spike does not spoil what follows";
  std::optional<std::string> last;
  for (int i = 0; i < 8; ++i) last = watch.refuse("w", at(3.0 + i, 0.13));
  EXPECT_EQ(last.value_or(""), "readings are stuck");
  EXPECT_EQ(watch.findings().size(), 2U);
}

// Property: rows with decreasing time are accepted; a file in reverse order keeps its evidence of weak
// ground.
TEST(SensorWatch, DecreasingTimeStartsANewSeries) {
  const auto model = testGround();
  SensorWatch watch(*model, {.stuck_rows = 8});
  for (int i = 0; i < 40; ++i) {
    EXPECT_FALSE(watch.refuse("w", at(10.0 - 0.1 * i, 0.1 + 0.01 * (i % 3))).has_value()) << i;
  }
  ASSERT_EQ(watch.findings().size(), 1U);
  EXPECT_NE(watch.findings()[0].find("39 rows: time decreases"), std::string::npos) << watch.findings()[0];
  // Property: equal readings before a decrease of time are not counted.
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(watch.refuse("v", at(10.0 + i, 0.2)).has_value()) << i;
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(watch.refuse("v", at(1.0 + i, 0.2)).has_value()) << i;
}

// Property: one stuck sensor of several is reported; a sensor with coarse rounding is not.
TEST(SensorWatch, SingleStuckSensorIsNamed) {
  const auto model = testGround();
  const auto reading = [](int i) {
    TelemetryReading r = at(0.1 * i, 0.1 + 0.001 * (i % 7));
    r.torque_Nm = 0.5 + 0.003 * (i % 11);
    r.sinkage_m = 0.001 * (i / 40);  // rounded to millimetres
    return r;
  };
  SensorWatch watch(*model);
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(watch.refuse("w", reading(i)).has_value()) << i;
  int believed = 0;
  for (int i = 40; i < 100; ++i) {
    TelemetryReading r = reading(i);
    r.torque_Nm = 0.51;
    const auto reason = watch.refuse("w", r);
    believed += reason ? 0 : 1;
    EXPECT_EQ(reason.value_or("torque is stuck"), "torque is stuck");
  }
  EXPECT_EQ(believed, 24);  // Closed form: the 25th equal reading is the first to be rejected
  EXPECT_FALSE(watch.refuse("w", reading(100)).has_value()) << "it moves again";
}

TEST(SensorWatch, PersistentStepIsNotASpike) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 10; ++i) watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3)));
  int refused = 0;
  for (int i = 0; i < 10; ++i) refused += watch.refuse("w", at(2.0 + 0.1 * i, 0.6 + 0.01 * (i % 3))) ? 1 : 0;
  EXPECT_LE(refused, 3);  // Closed form: the median of five changes after three readings
}

TEST(SensorWatch, TorqueOffsetIsDetectedAgainstTheSlope) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 40; ++i)
    watch.compare({.place = {}, .pull = {}, .sinkage = {}, .demand = 0.02, .from_torque = 0.09});
  EXPECT_TRUE(watch.biased());
  EXPECT_NEAR(watch.bias().value_or(0.0), 0.07, 1e-12);
  EXPECT_EQ(watch.findings().size(), 1U);
}

TEST(SensorWatch, NegativeSlipOfADrivenWheelUphillIsRejected) {
  const auto model = testGround();
  SensorWatch watch(*model);
  TelemetryReading up = at(1.0, -0.1);
  up.gradient = 0.1;
  EXPECT_NE(watch.refuse("w", up).value_or("").find("biased"), std::string::npos);
  TelemetryReading down = at(2.0, -0.1);
  down.gradient = -0.1;
  EXPECT_FALSE(watch.refuse("w", down).has_value()) << "braking downhill is no lie";
  TelemetryReading pushed = at(3.0, -0.1);
  pushed.gradient = 0.1;
  pushed.torque_Nm = -1.0;
  EXPECT_FALSE(watch.refuse("w", pushed).has_value()) << "a braked wheel may be pushed";
}

TEST(SensorWatch, JumpAtAllWheelsIsNotASpike) {
  const auto model = testGround();
  SensorWatch watch(*model);
  const auto moment = [&](double time_s, double left, double right) {
    return watch.refuse({{"left", at(time_s, left)}, {"right", at(time_s, right)}});
  };
  for (int i = 0; i < 10; ++i) moment(0.1 * i, 0.1 + 0.01 * (i % 3), 0.1 + 0.01 * (i % 2));
  const auto one = moment(2.0, 0.9, 0.1);
  EXPECT_EQ(one[0].value_or(""), "spike");
  EXPECT_FALSE(one[1].has_value());
  const auto both = moment(3.0, 0.9, 0.91);
  EXPECT_FALSE(both[0].has_value());
  EXPECT_FALSE(both[1].has_value());
  // A wheel that is refused for another reason does not turn the common jump of the others into spikes.
  TelemetryReading backwards = at(4.0, -0.5);
  backwards.gradient = 0.3;
  const auto three = watch.refuse({{"left", at(4.0, 0.1)}, {"right", at(4.0, 0.1)}, {"rear", backwards}});
  EXPECT_FALSE(three[0].has_value()) << three[0].value_or("");
  EXPECT_FALSE(three[1].has_value());
  EXPECT_TRUE(three[2].has_value());
}

}  // namespace sensor_watch_test
}  // namespace talus::costmap
