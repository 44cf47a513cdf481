#include <cmath>

#include <site_map.hpp>

#include <talus/costmap/telemetry/telemetry_processor.hpp>

namespace talus::costmap {
namespace telemetry_processor_test {

// Telemetry of one wheel that moves slowly east on level ground, column by column.
terramech::Telemetry quiet(int count) {
  terramech::Telemetry out;
  out.source = "t.csv";
  std::vector<double> x_m, y_m, load_N, slip, time_s, slope_rad, sinkage_m, torque_Nm;
  for (int i = 0; i < count; ++i) {
    x_m.push_back(102.0 + 0.1 * i);
    y_m.push_back(210.0);
    load_N.push_back(terramech::wheelLoad_N(testRover()));
    slip.push_back(0.1 + 0.001 * (i % 5));
    time_s.push_back(i);
    slope_rad.push_back(0.0);
    sinkage_m.push_back(0.01 + 1e-5 * (i % 7));
    torque_Nm.push_back(1.0 + 0.01 * (i % 3));
    out.lines.push_back(static_cast<std::size_t>(i) + 2);
  }
  out.numbers = {{"x_m", x_m},
                 {"y_m", y_m},
                 {"load_N", load_N},
                 {"slip", slip},
                 {"time_s", time_s},
                 {"slope_rad", slope_rad},
                 {"sinkage_m", sinkage_m},
                 {"torque_Nm", torque_Nm}};
  return out;
}

std::vector<TelemetryProcessor::Result> resultsOf(const terramech::Telemetry& t) {
  const TraversabilityMap map = mapOf(std::vector<std::string>(20, std::string(20, '1')));
  TelemetryProcessor processor(map);
  const TelemetryRows rows(t, map, 0.5);
  std::vector<TelemetryProcessor::Result> out;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (auto& result :
         processor.process(rows, momentOf(rows, {i}, map.model().rover()), processor.verdict()))
      out.push_back(std::move(result));
  return out;
}

std::vector<double>& column(terramech::Telemetry& t, const std::string& name) {
  for (auto& c : t.numbers)
    if (c.name == name) return c.values;
  throw std::logic_error(name);
}

TEST(TelemetryProcessor, SuspectedDangerousReadingsBoundThePlace) {
  terramech::Telemetry t = quiet(12);
  column(t, "slip")[9] = 0.93;
  column(t, "slip")[10] = -0.6;
  const auto results = resultsOf(t);
  EXPECT_EQ(results[9].reason, "spike");
  ASSERT_TRUE(results[9].observation);
  EXPECT_FALSE(results[9].observation->estimates()) << "it bounds its place and says nothing of other ground";
  EXPECT_LT(results[9].observation->here.most_pull, -0.3);
  EXPECT_EQ(results[10].reason, "spike");
  EXPECT_FALSE(results[10].observation &&
               results[10].observation->pull.value > testGround()->prior(0).pull.value)
      << "strength that looks like a fault is no evidence";
}

// Property: below the slip that counts as danger alone, a suspected low pull still bounds its place.
TEST(TelemetryProcessor, SuspectedPullBoundsThePlace) {
  terramech::Telemetry t = quiet(12);
  column(t, "slip")[9] = 0.68;
  column(t, "slope_rad")[9] = -0.25;
  const auto results = resultsOf(t);
  EXPECT_EQ(results[9].reason, "spike");
  ASSERT_TRUE(results[9].observation);
  EXPECT_FALSE(results[9].observation->estimates());
  EXPECT_LT(results[9].observation->here.most_pull, testGround()->prior(0).pull.value - 0.2);
}

TEST(TelemetryProcessor, MissingInputsAreNamed) {
  terramech::Telemetry t = quiet(3);
  for (const char* name : {"slope_rad", "torque_Nm", "sinkage_m"}) column(t, name).assign(3, NAN);
  for (const auto& result : resultsOf(t)) {
    EXPECT_FALSE(result.observation);
    EXPECT_NE(result.reason.find("needs slope, torque with sinkage, or drawbar pull"), std::string::npos);
  }
}

}  // namespace telemetry_processor_test
}  // namespace talus::costmap
