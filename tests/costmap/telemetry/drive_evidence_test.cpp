#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <site_map.hpp>
#include <unistd.h>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/telemetry/telemetry_processor.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::costmap {
namespace drive_evidence_test {

std::vector<std::string> wide() {
  return std::vector<std::string>(60, std::string(60, '1'));
}

// Telemetry with the given columns, from rows of numbers.
terramech::Telemetry tableOf(const std::string& source, const std::vector<std::string>& names,
                             const std::vector<std::vector<double>>& rows) {
  terramech::Telemetry out;
  out.source = source;
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::vector<double> column;
    for (const auto& row : rows) column.push_back(row[k]);
    out.numbers.push_back({names[k], column});
  }
  for (std::size_t line = 2; line < rows.size() + 2; ++line) out.lines.push_back(line);
  return out;
}

// A drive east along the middle over dust that the map classifies as sand; every tenth row lies outside the
// map.
terramech::Telemetry drive() {
  const terramech::Rover rover = testRover();
  const double load_N = terramech::wheelLoad_N(rover);
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < 100; ++i) {
    const double slip = 0.4 + 0.002 * i;
    const auto wheel = terramech::equilibrium(testDust(), rover.wheel, {.load_N = load_N, .slip = slip});
    rows.push_back({i % 10 == 9 ? -50.0 : 110.0 + 0.4 * i, 230.5, load_N, slip, wheel.torque_Nm,
                    wheel.sinkage_m, std::atan(wheel.drawbar_pull_N / load_N), 1.0 * i});
  }
  return tableOf("drive.csv",
                 {"x_m", "y_m", "load_N", "slip", "torque_Nm", "sinkage_m", "slope_rad", "time_s"}, rows);
}

std::string bytesOf(const TraversabilityMap& map) {
  std::stringstream stream;
  writeMap(map, stream);
  return stream.str();
}

TEST(AddDrive, DustDrivenAsSandIsEstimatedAsWeak) {
  TraversabilityMap map = mapOf(wide());
  const GroundBelief before = *map.ground({30, 30});
  const DriveReport report = addDrive(map, drive());
  EXPECT_EQ(report.used, 90U);
  EXPECT_EQ(report.rejected, 10U);
  const GroundBelief after = *map.ground({30, 30});
  EXPECT_LT(after.pull.value, before.pull.value - 0.1);
  EXPECT_NE(map.belief({30, 30}).category, static_cast<std::uint8_t>(terramech::Category::Safe));
}

// Returns the rows `first` to `end` - 1.
terramech::Telemetry partOf(terramech::Telemetry whole, std::ptrdiff_t first, std::ptrdiff_t end) {
  for (auto& column : whole.numbers)
    column.values = {column.values.begin() + first, column.values.begin() + end};
  whole.lines = {whole.lines.begin() + first, whole.lines.begin() + end};
  return whole;
}

// Property: evidence of weak ground is retained for reversed rows and for a wrong clock.
TEST(AddDrive, WeakGroundIsDetectedForReversedRowsAndWrongClock) {
  TraversabilityMap forward = mapOf(wide());
  addDrive(forward, drive());
  terramech::Telemetry reversed = drive(), late = drive(), back = drive();
  for (auto& column : reversed.numbers) std::reverse(column.values.begin(), column.values.end());
  late.numbers.back().values[5] = 1e9;
  for (std::size_t i = 50; i < 100; ++i) back.numbers.back().values[i] -= 1e6;
  const double weak = forward.ground({30, 30})->pull.value;
  for (const terramech::Telemetry& other : {reversed, late, back}) {
    TraversabilityMap map = mapOf(wide());
    const DriveReport report = addDrive(map, other);
    EXPECT_EQ(report.used, 90U);
    EXPECT_NEAR(map.ground({30, 30})->pull.value, weak, 0.03);
  }
}

// Property: a log that is sent again after it has grown adds only its new rows.
TEST(AddDrive, GrownFileAddsOnlyItsNewRows) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("grown" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  TraversabilityMap whole = mapOf(wide()), grown = mapOf(wide()), rebuilt = mapOf(wide());
  const DriveReport expected = addDrive(whole, drive());
  {
    EvidenceJournal journal((folder / "evidence.db").string());
    std::size_t used = 0, rejected = 0;
    for (const std::ptrdiff_t rows : {1, 40, 41, 99, 100}) {
      const DriveReport report = addDrive(grown, partOf(drive(), 0, rows), &journal);
      used += report.used;
      rejected += report.rejected;
      EXPECT_EQ(report.repeated + report.used + report.rejected, static_cast<std::size_t>(rows));
    }
    // Property: without sensor bias the result equals that of the whole file.
    EXPECT_EQ(used, expected.used);
    EXPECT_EQ(rejected, expected.rejected);
    EXPECT_EQ(journal.size(), 100);
    replay(rebuilt, journal);
  }
  EXPECT_EQ(bytesOf(rebuilt), bytesOf(grown));
  for (int row = 0; row < grown.grid().height; ++row)
    for (int column = 0; column < grown.grid().width; ++column) {
      const auto one = whole.ground({column, row}), other = grown.ground({column, row});
      ASSERT_EQ(one->pull.value, other->pull.value) << column << ' ' << row;
      ASSERT_EQ(one->pull.std, other->pull.std) << column << ' ' << row;
    }
  EXPECT_EQ(addDrive(grown, drive()).repeated, 100U);
  // A file with a different beginning is another drive.
  EXPECT_EQ(addDrive(grown, partOf(drive(), 1, 100)).repeated, 0U);
  std::filesystem::remove_all(folder);
}

// Four wheels uphill at one slip, each with the torque of its own load. `told`: true if the load column has
// the actual loads, false if it has equal shares.
terramech::Telemetry climb(bool told) {
  const terramech::Rover rover = testRover();
  const double gradient = 0.15;
  const std::vector<double> along{0.4, 0.4, -0.4, -0.4};
  const auto loads_N = terramech::wheelLoads_N(rover, gradient, along);
  std::vector<std::vector<double>> rows;
  std::vector<std::string> wheel;
  for (int moment = 0; moment < 30; ++moment)
    for (std::size_t w = 0; w < 4; ++w) {
      const auto forces =
          terramech::equilibrium(testSand(), rover.wheel, {.load_N = loads_N[w], .slip = 0.3});
      rows.push_back({120.0 + 0.3 * moment + along[w], 230.5 + (w % 2 == 0 ? 0.3 : -0.3),
                      told ? loads_N[w] : terramech::wheelLoad_N(rover), 0.3 + 1e-4 * moment,
                      forces.torque_Nm, forces.sinkage_m, std::atan(gradient), 0.0, 1.0 * moment});
      wheel.push_back("w" + std::to_string(w));
    }
  terramech::Telemetry out = tableOf(
      "climb.csv",
      {"x_m", "y_m", "load_N", "slip", "torque_Nm", "sinkage_m", "slope_rad", "heading_rad", "time_s"}, rows);
  out.words = {{"wheel", wheel}};
  return out;
}

TEST(AddDrive, LoadTransferIsComputedIfTheFileOmitsIt) {
  TraversabilityMap right = mapOf(wide()), even = mapOf(wide());
  EXPECT_THAT(addDrive(right, climb(true)).findings,
              testing::Not(testing::Contains(testing::HasSubstr("load transfer"))));
  EXPECT_THAT(addDrive(even, climb(false)).findings, testing::Contains(testing::HasSubstr("load transfer")));
  // Closed form: after the correction of the loads both files give the same pull
  EXPECT_NEAR(even.ground({24, 30})->pull.value, right.ground({24, 30})->pull.value, 1e-6);
}

TEST(Replay, ReplayRebuildsTheMapExactly) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("replay" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  TraversabilityMap map = mapOf(wide()), rebuilt = mapOf(wide());
  {
    EvidenceJournal journal((folder / "evidence.db").string());
    addDrive(map, drive(), &journal);
    EXPECT_EQ(journal.size(), 100);
    replay(rebuilt, journal);
  }
  EXPECT_EQ(bytesOf(rebuilt), bytesOf(map));
  std::filesystem::remove_all(folder);
}

}  // namespace drive_evidence_test
}  // namespace talus::costmap
