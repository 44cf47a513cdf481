#include <cmath>

#include <site_fixture.hpp>

#include <costmap/sensor_watch.hpp>

namespace talus::costmap {
namespace {

WheelReading at(double time_s, double slip) {
  return {.time_s = time_s,
          .place = {},
          .load_N = 50.0,
          .slip = slip,
          .torque_Nm = 1.0 + 0.01 * slip,
          .sinkage_m = 0.01};
}

TEST(SensorWatch, BelievesAQuietDrive) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3))).has_value());
  EXPECT_TRUE(watch.findings().empty());
}

TEST(SensorWatch, SeesTimeGoingBackStuckValuesAndSpikes) {
  const auto model = testGround();
  SensorWatch watch(*model, {.stuck_rows = 8});
  for (int i = 0; i < 10; ++i) watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3)));
  EXPECT_EQ(watch.refuse("w", at(0.2, 0.11)).value_or(""), "time goes back");
  EXPECT_EQ(watch.refuse("w", at(2.0, 0.9)).value_or(""), "spike");
  EXPECT_FALSE(watch.refuse("w", at(2.1, 0.12)).has_value()) << "one spike does not spoil what follows";
  std::optional<std::string> last;
  for (int i = 0; i < 8; ++i) last = watch.refuse("w", at(3.0 + i, 0.13));
  EXPECT_EQ(last.value_or(""), "readings are stuck");
  EXPECT_EQ(watch.findings().size(), 3U);
}

TEST(SensorWatch, AStepThatStaysIsGroundNotASpike) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 10; ++i) watch.refuse("w", at(0.1 * i, 0.1 + 0.01 * (i % 3)));
  int refused = 0;
  for (int i = 0; i < 10; ++i) refused += watch.refuse("w", at(2.0 + 0.1 * i, 0.6 + 0.01 * (i % 3))) ? 1 : 0;
  EXPECT_LE(refused, 3);  // Closed form: a median of five follows after three
}

TEST(SensorWatch, AnOffsetInTheTorqueShowsAgainstTheSlope) {
  const auto model = testGround();
  SensorWatch watch(*model);
  for (int i = 0; i < 40; ++i)
    watch.compare({.place = {}, .pull = {}, .sinkage = {}, .demand = 0.02, .from_torque = 0.09});
  EXPECT_TRUE(watch.biased());
  EXPECT_NEAR(watch.bias().value_or(0.0), 0.07, 1e-12);
  EXPECT_EQ(watch.findings().size(), 1U);
}

}  // namespace
}  // namespace talus::costmap
