#include <cmath>

#include <talus/common/common.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "requirement.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace telemetry_reader_test {

using testing::ElementsAre;
using testing::HasSubstr;

Telemetry read(const std::string& content, const TelemetryOptions& options = {}) {
  const test::TemporaryFile file{content};
  return readTelemetry(file.path(), options);
}

std::string errorOf(const std::string& content, const TelemetryOptions& options = {}) {
  try {
    read(content, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(TelemetryReader, KeepsEveryColumnInAnyOrder) {
  const Telemetry t = read("note,slip,moisture,load_N,run,wheel\nwet,0.2,3.5,80,1,2\ndry,-1,,81,2,FL\n");
  EXPECT_THAT(t.at("slip"), ElementsAre(0.2, -1.0));
  EXPECT_THAT(*t.findWords("note"), ElementsAre("wet", "dry"));
  EXPECT_THAT(*t.findWords("run"), ElementsAre("1", "2"));
  EXPECT_EQ(t.at("moisture")[0], 3.5);
  EXPECT_TRUE(std::isnan(t.at("moisture")[1]));
  EXPECT_EQ(t.find("torque_Nm"), nullptr);
  EXPECT_THAT(t.lines, ElementsAre(2, 3));
}

// Property: physically impossible readings are rejected.
TEST(TelemetryReader, RejectsPhysicallyImpossibleValues) {
  for (const char* column :
       {"slope_rad=1.5708", "slope_rad=-10", "roll_rad=2", "pass_index=-1", "pass_index=0.5",
        "pass_index=1e15", "x_m=1e15", "y_m=-1e10", "z_m=1e12", "wheel_width_m=1e15", "wheel_width_m=1e-12",
        "grouser_height_m=3", "grouser_count=1e9", "shear_modulus_m=1e15"}) {
    const std::string text = column;
    const std::size_t at = text.find('=');
    const Telemetry t = read("load_N," + text.substr(0, at) + "\n80," + text.substr(at + 1) + "\n80,\n");
    ASSERT_EQ(t.rejected.size(), 1U) << text;
    EXPECT_EQ(t.rejected[0].line, 2U);
  }
}

// Property: a column in percent or degrees is refused, not thinned out to its small values; the unit that an option
// states is taken; single faults are rows that are left out.
TEST(TelemetryReader, PercentAndDegreesAreRefusedWithTheOptionThatReadsThem) {
  const auto column = [](const std::string& name, std::initializer_list<double> values) {
    std::string text = "load_N," + name + "\n";
    for (const double v : values) text += "80," + std::to_string(v) + "\n";
    return text;
  };
  const std::string gentle = column("slip", {0.7, 0.4, 0.9, 5, 0.8, 0.5, 12, 1.1, 2.2, 3});
  EXPECT_THAT(errorOf(gentle),
              HasSubstr("column slip: 4 of 10 values lie beyond 1.6, as percent do; pass --column "
                        "slip=slip:percent, or slip=slip:ratio if"));
  EXPECT_THAT(errorOf(column("slope_rad", {10, 1, 14, -12})),
              HasSubstr("pass --column slope_rad=slope_rad:deg"));
  EXPECT_THAT(errorOf(column("heading_rad", {90, 91, 90})), HasSubstr("heading_rad=heading_rad:deg"));
  for (const auto& [factor, unit] : {std::pair{1e3, "ms"}, {1e6, "us"}, {1e9, "ns"}})
    EXPECT_THAT(errorOf(column("time_s", {1.7e9 * factor, 1.8e9 * factor})),
                HasSubstr("--column time_s=time_s:" + std::string(unit) + ","));
  const test::TemporaryFile file{gentle};
  TableFile table(file.path());
  table.columns = {{.known = "slip", .name = "slip", .unit = "percent"}};
  EXPECT_NEAR(readTelemetry(table).at("slip").back(), 0.03, 1e-15);
  table.columns = {{.known = "slip", .name = "slip", .unit = "ratio"}};
  EXPECT_EQ(readTelemetry(table).rejected.size(), 5U);
  EXPECT_EQ(read(column("slip", {0.12, 0.35, 40, 0.08})).rejected.size(), 1U);
}

TEST(TelemetryReader, RejectedRowsHaveLineAndReason) {
  struct Case {
    const char* row;
    const char* reason;
  };
  const std::string good = "80,0.02,0.3,0.1\n";
  for (const Case& c : {Case{"0,0.02,0.3,0.1", "load_N = 0, must be > 0 and at most 1e7"},
                        {"1e12,0.02,0.3,0.1", "load_N = 1e12, must be > 0 and at most 1e7"},
                        {"nan,0.02,0.3,0.1", "load_N = nan, must be finite"},
                        {"80,0.02,inf,0.1", "slip = inf, must be finite"},
                        {"80,-0.001,0.3,0.1", "sinkage_m = -0.001, must be >= 0"},
                        {"80,0.2,0.3,0.1", "sinkage_m = 0.2, must be < the wheel's diameter, 0.2"},
                        {"80,0.02,1.01,0.1", "slip = 1.01, must be in [-1, 1]"},
                        {"80,0.02,-1.01,0.1", "slip = -1.01, must be in [-1, 1]"},
                        {"80,0.02,0.3,-0.1", "wheel_radius_m = -0.1, must be in [0.001, 10]"},
                        {"80,0.02,0.3,1e14", "wheel_radius_m = 1e14, must be in [0.001, 10]"},
                        {"heavy,0.02,0.3,0.1", "load_N = 'heavy', must be a number"},
                        {"80,0.02", "has 2 fields, the header 4"},
                        {"load_N,sinkage_m,slip,wheel_radius_m", "repeats the header"}}) {
    const Telemetry t = read("load_N,sinkage_m,slip,wheel_radius_m\n" + good + c.row + "\n" + good);
    ASSERT_EQ(t.rejected.size(), 1U) << c.row;
    EXPECT_EQ(t.rejected[0].line, 3U);
    EXPECT_EQ(t.rejected[0].reason, c.reason);
    EXPECT_EQ(t.size(), 2U);
  }
}

// Measured by others: a wheel pulled across its travel reads up to 1.576 rad.
TEST(TelemetryReader, SlipAngleIsLimitedToARightAngle) {
  const Telemetry t = read("load_N,slip_angle_rad\n80,1.576\n80,-1.576\n80,1.61\n80,-3.14159\n");
  EXPECT_EQ(t.size(), 2U);
  ASSERT_EQ(t.rejected.size(), 2U);
  EXPECT_EQ(t.rejected[0].line, 4U);
  EXPECT_EQ(t.rejected[0].reason, "slip_angle_rad = 1.61, must be in [-1.6, 1.6]");
}

TEST(TelemetryReader, KeepsTheNumbersOfRejectedRows) {
  const Telemetry t =
      read("load_N,slip,note,sinkage_m\n80,0.1,a,0\n80,inf,b,x\n80,0.2,c,0\nnan,0.9,d,-1\n80\n");
  ASSERT_EQ(t.rejected.size(), 3U);
  ASSERT_EQ(t.rejected_numbers.size(), 3U) << "known columns";
  EXPECT_EQ(t.rejected_numbers[1].name, "slip");
  EXPECT_EQ(t.rejected_numbers[1].values[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(t.rejected_numbers[1].values[1], 0.9);
  EXPECT_TRUE(std::isnan(t.rejected_numbers[1].values[2])) << "the row is cut short";
  EXPECT_TRUE(std::isnan(t.rejected_numbers[0].values[1]));
  EXPECT_TRUE(std::isnan(t.rejected_numbers[2].values[0])) << "a word";
  EXPECT_EQ(t.rejected_numbers[2].values[1], -1.0);
}

TEST(TelemetryReader, NumbersBeyondDoubleRangeSaturateInRejectedRows) {
  const auto t = read("load_N,slip,sinkage_m\n1,0.1,1e999\n1,-1e400,0\n1,1e300,0\n-1,1e-999,0x\n1,0.5,0\n");
  constexpr double kMost = std::numeric_limits<double>::max();
  ASSERT_EQ(t.rejected.size(), 4U);
  EXPECT_EQ(t.rejected_numbers[2].values[0], kMost);
  EXPECT_EQ(t.rejected_numbers[1].values[1], -kMost);
  EXPECT_EQ(t.rejected_numbers[1].values[2], 1e300);
  EXPECT_EQ(t.rejected_numbers[1].values[3], 0.0);
  EXPECT_TRUE(std::isnan(t.rejected_numbers[2].values[3])) << "a word";
}

TEST(TelemetryReader, RangeLimitsAreInclusive) {
  const Telemetry t = read("slip,sinkage_m\n1,0\n-1,0.1\n");
  EXPECT_EQ(t.size(), 2U);
  EXPECT_EQ(t.rejected.size(), 0U);
}

TEST(TelemetryReader, RoundingNoiseIsReadAsZero) {
  const Telemetry t = read("pitch_rad,load_N\n4.3e-18,10\n-1e-300,10\n0.1,1e-300\n");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(t.at("pitch_rad")[0], 0.0);
  EXPECT_EQ(t.at("pitch_rad")[1], 0.0);
  ASSERT_EQ(t.rejected.size(), 1U);
  EXPECT_EQ(t.rejected[0].reason, "load_N = 1e-300, must be > 0 and at most 1e7");
}

TEST(TelemetryReader, RejectsTruncatedLastRow) {
  const Telemetry t = read("load_N,slip,torque_Nm\n80,0.2,1\n80,0.");
  EXPECT_EQ(t.size(), 1U);
  EXPECT_EQ(t.rejected[0].line, 3U);
}

TEST(TelemetryReader, RequiredColumnsMustBePresentInEveryRow) {
  EXPECT_THAT(errorOf("slip\n0.1\n", {.required = {"slip", "load_N", "torque_Nm"}}),
              HasSubstr(":1: no column load_N, torque_Nm"));
  const Telemetry t = read("slip,load_N\n0.1,\n0.2,80\n", {.required = {"slip", "load_N"}});
  EXPECT_EQ(t.rejected[0].reason, "load_N is empty");
  EXPECT_EQ(t.size(), 1U);
}

TEST(TelemetryReader, GivenRadiusIsUsedIfTheFileHasNone) {
  EXPECT_THAT(errorOf("sinkage_m\n0.3\n", {.required = {}, .wheel_radius_m = 0.1}),
              HasSubstr("must be < the wheel's"));
  EXPECT_EQ(read("sinkage_m\n0.3\n").size(), 1U);
}

TEST(TelemetryReader, FileWithoutUsableRowIsRejected) {
  EXPECT_THAT(errorOf("load_N\n"), HasSubstr("no rows after the header"));
  EXPECT_THAT(errorOf("load_N\n-1\n-2\n"),
              HasSubstr(":2: no usable row; 2 refused, this one because load_N = -1"));
}

TEST(TelemetryReader, ReportsProgressAndStopsOnRequest) {
  std::string content = "slip\n";
  for (int k = 0; k < 200000; ++k) content += "0.5\n";
  const test::TemporaryFile file{content};
  std::stop_source stop;
  double last = 0.0;
  const ProgressMonitor watch{[&](double fraction) {
                                EXPECT_GE(fraction, last);
                                last = fraction;
                                if (fraction > 0.3) stop.request_stop();
                              },
                              stop.get_token()};
  EXPECT_LT(readTelemetry(file.path(), {}, watch).size(), 200000U);
  EXPECT_GT(last, 0.3);
}

// Property: on request, repeated rows of a log with overlapping parts count once.
TEST(TelemetryReader, RepeatedRowsAreCountedOnceOnRequest) {
  const std::string part = "1,80,0.1\n2,81,0.2\n2,81,0.2\n3,-82,0.3\n", header = "time_s,load_N,slip\n";
  const Telemetry once = read(header + part + part + "1,80,0.4\n", {.once = true});
  // Two different rows of one time may belong to two wheels.
  EXPECT_THAT(once.at("slip"), ElementsAre(0.1, 0.2, 0.2, 0.4));
  EXPECT_THAT(once.lines, ElementsAre(2, 3, 4, 10));
  EXPECT_EQ(once.rejected.size(), 1U);
  EXPECT_EQ(once.repeated, 4U);
  EXPECT_EQ(read(header + part + part).size(), 6U);
  // Without a time column any row may be a repeated measurement.
  EXPECT_EQ(read("load_N,slip\n80,0.1\n81,0.2\n80,0.1\n", {.once = true}).size(), 3U);
  const std::string named = "time_s,wheel,load_N,slip\n1,a,80,0.1\n1,b,80,0.1\n1,a,80,0.1\n";
  EXPECT_THAT(read(named, {.once = true}).lines, ElementsAre(2, 3));
}

TEST(TelemetryReader, MeasuredDataFilesAreRead) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  TALUS_REQUIRE(folder != nullptr, "TALUS_MEASURED_DATA is not set");
  const Telemetry ding = readTelemetry(std::string(folder) + "/single_wheel_digitised/points.csv");
  EXPECT_EQ(ding.size() + ding.rejected.size(), 11U);
  const Telemetry cmu = readTelemetry(std::string(folder) + "/cmu_testbed/runs.csv");
  EXPECT_EQ(cmu.size() + cmu.rejected.size(), 216U);
}

}  // namespace telemetry_reader_test
}  // namespace talus::terramech
