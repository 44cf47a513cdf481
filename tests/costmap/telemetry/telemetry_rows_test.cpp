#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <refused.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {

namespace telemetry_rows_test {

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

TEST(TelemetryRows, SlipFollowsFromTravelAndRimSpeed) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  t.numbers.push_back({"speed_mps", {0.01, 0.05, 0.0, -0.05, 0.02}});
  t.numbers.push_back({"rim_speed_mps", {0.05, 0.05, 0.05, 0.05, 0.004}});
  const TelemetryRows rows(t, map, 0.5);
  // Closed form: 1 - v/(r omega)
  EXPECT_NEAR(rows.reading(0).speed_slip, 0.8, 1e-12);
  EXPECT_NEAR(rows.reading(1).speed_slip, 0.0, 1e-12);
  EXPECT_NEAR(rows.reading(2).speed_slip, 1.0, 1e-12);
  EXPECT_NEAR(rows.reading(3).speed_slip, 2.0, 1e-12);
  EXPECT_TRUE(std::isnan(rows.reading(4).speed_slip)) << "a wheel that does not turn";
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

TEST(TelemetryRows, SpeedSlipIsSignSymmetricAndNanIfUndefined) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  t.numbers.push_back({"speed_mps", {0.005, 0.1, 0.0, NAN, 0.1}});
  t.numbers.push_back({"rim_speed_mps", {0.1, 0.1, 0.0, 0.1, NAN}});
  const TelemetryRows rows(t, map, 0.5);
  EXPECT_NEAR(rows.reading(0).speed_slip, 0.95, 1e-12);
  EXPECT_NEAR(rows.reading(1).speed_slip, 0.0, 1e-12);
  for (const std::size_t i : {2U, 3U, 4U}) EXPECT_TRUE(std::isnan(rows.reading(i).speed_slip));
  // Property: driving in reverse gives the same slips.
  for (std::size_t k = t.numbers.size() - 2; k < t.numbers.size(); ++k)
    for (double& v : t.numbers[k].values) v = -v;
  const TelemetryRows back(t, map, 0.5);
  EXPECT_NEAR(back.reading(0).speed_slip, 0.95, 1e-12);
  EXPECT_NEAR(back.reading(1).speed_slip, 0.0, 1e-12);
}

TEST(TelemetryRows, MissingColumnIsNamed) {
  const TraversabilityMap map = ramp();
  terramech::Telemetry t = table();
  t.numbers.erase(t.numbers.begin() + 3);
  EXPECT_REFUSED(TelemetryRows(t, map, 0.5), InputError, "no column slip");
}

}  // namespace telemetry_rows_test

}  // namespace talus::costmap
