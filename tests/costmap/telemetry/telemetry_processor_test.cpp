#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include <refused.hpp>
#include <site_fixture.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/telemetry/telemetry_processor.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {
namespace telemetry_processor_test {

std::string driveId(const terramech::Telemetry& telemetry) {
  DriveId id;
  id.add(telemetry);
  return id.text();
}

// A drive with every used column: two accepted rows and a rejected one between them.
terramech::Telemetry drive() {
  terramech::Telemetry out;
  out.source = "t.csv";
  double value = 0.1;
  for (const std::string_view name : usedNumberColumns()) {
    out.numbers.push_back({std::string(name), {value, value + 0.01}});
    out.rejected_numbers.push_back({std::string(name), {value + 0.02}});
    value += 0.03;
  }
  for (const std::string_view name : usedWordColumns()) out.words.push_back({std::string(name), {"a", "b"}});
  out.lines = {2, 4};
  out.rejected = {{3, "load_N = -3, must be > 0"}};
  return out;
}

// Property: the id of a drive is independent of the order of columns, of unused columns and of empty
// columns, so that such a file is not counted twice.
TEST(DriveId, IdIsIndependentOfColumnOrderAndUnusedColumns) {
  const std::string id = driveId(drive());
  terramech::Telemetry turned = drive();
  std::ranges::reverse(turned.numbers);
  std::ranges::reverse(turned.words);
  std::ranges::reverse(turned.rejected_numbers);
  EXPECT_EQ(driveId(turned), id);
  terramech::Telemetry more = drive();
  more.words.push_back({"remark", {"x", "y"}});
  more.numbers.insert(more.numbers.begin(), {"temperature_K", {250.0, NAN}});
  EXPECT_EQ(driveId(more), id);
  terramech::Telemetry less = drive(), empty = drive();
  std::erase_if(less.numbers, [](const auto& column) { return column.name == "z_m"; });
  for (auto& column : empty.numbers)
    if (column.name == "z_m") column.values = {NAN, -NAN};
  EXPECT_EQ(driveId(less), driveId(empty));
  terramech::Telemetry footer = drive();
  footer.rejected.push_back({5, "load_N = 'end', must be a number"});
  for (auto& column : footer.rejected_numbers) column.values.push_back(NAN);
  EXPECT_EQ(driveId(footer), id);
  EXPECT_NE(driveId(less), id);
}

// Property: a change of any used value, also in rejected rows, or of the order of rows makes a different id.
TEST(DriveId, IdDependsOnEveryUsedValue) {
  std::set<std::string> ids{driveId(drive())};
  std::size_t tables = 1;
  const auto add = [&](auto&& change) {
    terramech::Telemetry changed = drive();
    change(changed);
    ids.insert(driveId(changed));
    EXPECT_EQ(ids.size(), ++tables);
  };
  for (std::size_t column = 0; column < usedNumberColumns().size(); ++column) {
    add([&](auto& t) { t.numbers[column].values[1] += 1.0; });
    add([&](auto& t) { t.rejected_numbers[column].values[0] += 1.0; });
  }
  for (std::size_t column = 0; column < usedWordColumns().size(); ++column)
    add([&](auto& t) { t.words[column].values[0] = "c"; });
  add([](auto& t) { t.rejected[0].line = 5; });
  add([](auto& t) {
    for (auto& column : t.numbers) std::swap(column.values[0], column.values[1]);
  });
}

// Property: the id of a divided drive is that of the whole drive.
TEST(DriveId, IdIsIndependentOfDivision) {
  terramech::Telemetry first = drive(), second = drive();
  for (auto* columns : {&first.numbers, &second.numbers})
    for (auto& column : *columns) column.values.erase(column.values.begin() + (columns == &first.numbers));
  for (auto* columns : {&first.words, &second.words})
    for (auto& column : *columns) column.values.erase(column.values.begin() + (columns == &first.words));
  first.lines = {2};
  second.lines = {4};
  second.rejected.clear();
  second.rejected_numbers.clear();
  DriveId id;
  id.add(first);
  id.add(second);
  EXPECT_EQ(id.text(), driveId(drive()));
}

TraversabilityMap ramp() {
  return mapOf(std::vector<std::string>(20, std::string(20, '1')), 0.1);
}

// Three moments of two wheels; the last moment has one wheel only.
terramech::Telemetry table() {
  terramech::Telemetry out;
  out.source = "t.csv";
  out.numbers = {{"x_m", {105, 105, 106, 106, 107}},
                 {"y_m", {210, 211, 210, 211, 210}},
                 {"load_N", {50, 50, 50, 50, 50}},
                 {"slip", {0.1, 0.2, 0.3, 0.4, 0.5}},
                 {"time_s", {1, 1, 2, 2, 3}},
                 {"heading_rad", {0, 0, 0, 0, std::numbers::pi}},
                 {"slope_rad", {0.2, 0.2, NAN, NAN, NAN}},
                 {"pose_std_m", {NAN, 0.3, -1, 2, 1e14}}};
  out.words = {{"wheel", {"a", "b", "a", "b", "a"}}, {"run", {"r", "r", "r", "r", "r"}}};
  out.lines = {2, 3, 4, 5, 6};
  return out;
}

TEST(TelemetryRows, SlopeOfTheRowOverridesTheMapSlope) {
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

TEST(TelemetryRows, PoseErrorOfTheRowOverridesTheStatedOne) {
  const TraversabilityMap map = ramp();
  const terramech::Telemetry t = table();
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_EQ(rows.reading(0).pose_std_m, 0.5);
  EXPECT_EQ(rows.reading(1).pose_std_m, 0.3);
  EXPECT_EQ(rows.reading(2).pose_std_m, 0.0);
  EXPECT_EQ(rows.reading(4).pose_std_m, 1000.0) << "the journal takes no more";
}

// Closed form: 1 - v/(r omega), the same in reverse.
TEST(TelemetryRows, SlipFollowsFromTravelAndRimSpeed) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  for (const double way : {1.0, -1.0}) {
    t.numbers.resize(table().numbers.size());
    t.numbers.push_back({"speed_mps", {way * 0.01, way * 0.05, 0.0, way * -0.05, way * 0.02}});
    t.numbers.push_back({"rim_speed_mps", {way * 0.05, way * 0.05, way * 0.05, way * 0.05, way * 0.004}});
    const TelemetryRows rows(t, map, 0.5);
    EXPECT_NEAR(rows.reading(0).speed_slip, 0.8, 1e-12);
    EXPECT_NEAR(rows.reading(1).speed_slip, 0.0, 1e-12);
    EXPECT_NEAR(rows.reading(2).speed_slip, 1.0, 1e-12);
    EXPECT_NEAR(rows.reading(3).speed_slip, 2.0, 1e-12);
    EXPECT_TRUE(std::isnan(rows.reading(4).speed_slip)) << "a wheel that does not turn";
  }
  t.numbers.end()[-2].values = {0.0, NAN, 0.1, NAN, 0.0};
  t.numbers.end()[-1].values = {0.0, 0.1, NAN, NAN, NAN};
  const TelemetryRows undefined(t, map, 0.5);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(std::isnan(undefined.reading(i).speed_slip)) << i;
}

// Property: a slope beyond vertical is ignored; a row with an unreliable heading is assumed to be straight
// downhill.
TEST(TelemetryRows, LeastGradientIgnoresImpossibleSlopes) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  for (auto& column : t.numbers)
    if (column.name == "slope_rad") column.values = {0.2, 1e14, -1e14, -0.3, NAN};
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_NEAR(rows.leastGradient(0), 0.1, 1e-3);
  EXPECT_NEAR(rows.leastGradient(1), 0.1, 1e-3);
  EXPECT_NEAR(rows.leastGradient(2), 0.1, 1e-3);
  EXPECT_NEAR(rows.leastGradient(3), std::tan(-0.3), 1e-12);
  EXPECT_NEAR(rows.leastGradient(4), -0.1, 1e-3);
  for (const std::size_t i : {0U, 1U, 2U, 4U}) EXPECT_NEAR(rows.steepestDescent(i), -0.1, 1e-3);
  EXPECT_NEAR(rows.steepestDescent(3), std::tan(-0.3), 1e-12);
}

TEST(TelemetryRows, MomentContainsAllWheelsOfOneTime) {
  const TraversabilityMap map = ramp();
  const terramech::Telemetry t = table();
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_EQ(rows.byMoment(), (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}, {4}}));
  EXPECT_EQ(momentOf(rows, {2, 3}, map.model().rover()).readings.size(), 2U);
}

TEST(TelemetryRows, LeastGradientWithoutHeadingIsTheSteepestDescent) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  EXPECT_NEAR(TelemetryRows(t, map, 0.5).leastGradient(0), 0.1, 1e-3) << "the map's, less than the rover's";
  t.numbers[5].values.assign(5, std::numeric_limits<double>::infinity());
  t.numbers[6].values.assign(5, NAN);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(TelemetryRows(t, map, 0.5).leastGradient(i), -0.1, 1e-3);
}

TEST(TelemetryRows, MissingColumnIsNamed) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  t.numbers.erase(t.numbers.begin() + 3);
  EXPECT_REFUSED(TelemetryRows(t, map, 0.5), InputError, "no column slip");
}

// Tests of the bounds from each channel of one reading.

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
      const double at = model->steady(0, {.slip = slip, .in_rut = pass > 1}).drawbar_pull_over_load;
      EXPECT_NEAR(watch.bound(0, reading, 0.1).most_pull, model->prior(0).pull.value + 0.1 - at + 0.05,
                  1e-12);
    }
  EXPECT_NE(model->steady(0, {.slip = 0.72, .in_rut = true}).drawbar_pull_over_load,
            model->steady(0, {.slip = 0.72, .in_rut = false}).drawbar_pull_over_load);
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

TEST(TelemetryProcessor, DangerousReadingBoundsItsPlaceAlone) {
  terramech::Telemetry t = quiet(12);
  column(t, "slip")[9] = 0.93;
  const auto results = resultsOf(t);
  for (std::size_t i = 0; i < results.size(); ++i) {
    ASSERT_TRUE(results[i].observation);
    EXPECT_EQ(results[i].observation->here.any(), i == 9) << i;
  }
  EXPECT_LT(results[9].observation->here.most_pull, -0.3);
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
