#include <cmath>

#include <site_map.hpp>

#include <talus/costmap/telemetry_rows.hpp>

namespace talus::costmap {
namespace {

TraversabilityMap ramp() {
  return mapOf(std::vector<std::string>(20, std::string(20, '1')), 0.1);
}

// Three moments of two wheels; the last of one only.
terramech::Telemetry table() {
  terramech::Telemetry out;
  out.source = "t.csv";
  out.numbers = {{"x_m", {105, 105, 106, 106, 107}},
                 {"y_m", {210, 211, 210, 211, 210}},
                 {"load_N", {50, 50, 50, 50, 50}},
                 {"slip", {0.1, 0.2, 0.3, 0.4, 0.5}},
                 {"time_s", {1, 1, 2, 2, 3}},
                 {"heading_rad", {0, 0, 0, 0, M_PI}},
                 {"slope_rad", {0.2, 0.2, NAN, NAN, NAN}},
                 {"pose_std_m", {NAN, 0.3, -1, 2, NAN}}};
  out.words = {{"wheel", {"a", "b", "a", "b", "a"}}, {"run", {"r", "r", "r", "r", "r"}}};
  out.lines = {2, 3, 4, 5, 6};
  return out;
}

TEST(TelemetryRows, TakesTheRowsOwnSlopeElseTheMapsAlongTheHeading) {
  const TraversabilityMap map = ramp();
  const terramech::Telemetry t = table();
  const TelemetryRows rows(t, map, 0.5);
  ASSERT_EQ(rows.size(), 5U);
  // Closed form: tan(0.2); a plane that rises by 0.1 eastwards, stored in steps of 1/1024
  EXPECT_NEAR(rows.reading(0).gradient, std::tan(0.2), 1e-12);
  EXPECT_NEAR(rows.reading(2).gradient, 0.1, 1e-3);
  EXPECT_NEAR(rows.reading(4).gradient, -0.1, 1e-3);
  EXPECT_TRUE(std::isnan(rows.measuredGradient(2)));
  EXPECT_NEAR(rows.mapGradient(0), 0.1, 1e-3);
}

TEST(TelemetryRows, PoseErrorIsTheRowsElseTheOneStated) {
  const TraversabilityMap map = ramp();
  const terramech::Telemetry t = table();
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_EQ(rows.reading(0).pose_std_m, 0.5);
  EXPECT_EQ(rows.reading(1).pose_std_m, 0.3);
  EXPECT_EQ(rows.reading(2).pose_std_m, 0.0);
}

TEST(TelemetryRows, AMomentIsAllWheelsOfOneTime) {
  const TraversabilityMap map = ramp();
  const terramech::Telemetry t = table();
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_EQ(rows.endOfMoment(0), 2U);
  EXPECT_EQ(rows.endOfMoment(2), 4U);
  EXPECT_EQ(rows.endOfMoment(4), 5U);
  EXPECT_EQ(momentAt(rows, 2, map.model().rover()).readings.size(), 2U);
}

TEST(TelemetryRows, NamesAColumnThatIsMissing) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  t.numbers.erase(t.numbers.begin() + 3);
  EXPECT_THROW(TelemetryRows(t, map, 0.5), InputError);
}

}  // namespace
}  // namespace talus::costmap
