// Property: rows of another wheel, load or rover raise no estimate, in a file and in a journal; rows of the
// same rover raise estimates.
#include <filesystem>

#include <rover_drive.hpp>
#include <unistd.h>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace other_wheel_test {

constexpr double kHeight_m = 1.0;

TraversabilityMap sand(double mass_kg = testRover().mass_kg) {
  GroundModel::Parts parts = groundOf(testSand(), 4)->parts();
  parts.rover.mass_kg = mass_kg;
  return TraversabilityMap(hills(kHeight_m), std::make_shared<GroundModel>(std::move(parts)), {});
}

terramech::Telemetry drive() {
  return tableOf(driveOver(sand(), testSand(), 1));
}

void setColumn(terramech::Telemetry& table, const char* name, double value) {
  table.numbers.push_back({name, std::vector<double>(table.size(), value)});
}

// Number of cells whose estimate is more certain or stronger than before.
int better(const TraversabilityMap& before, const TraversabilityMap& after) {
  int count = 0;
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column) {
      const Estimate a = before.ground({column, row})->pull, b = after.ground({column, row})->pull;
      count += b.value > a.value + 1e-9;
    }
  return count;
}

std::size_t findings(const DriveReport& report) {
  std::size_t count = 0;
  for (const std::string& finding : report.findings)
    count += finding.find("another wheel or load") != std::string::npos;
  return count;
}

TEST(OwnWheel, ReadingsOfTheRoverWheelRaiseEstimates) {
  const TraversabilityMap before = sand();
  TraversabilityMap silent = sand(), stated = sand();
  terramech::Telemetry table = measuredTwice(drive());
  const DriveReport report = addDrive(silent, table);
  EXPECT_GT(report.raising, 0U);
  EXPECT_EQ(findings(report), 0U);
  EXPECT_GT(better(before, silent), 100);
  setColumn(table, "wheel_radius_m", testRover().wheel.radius_m);
  setColumn(table, "wheel_width_m", testRover().wheel.width_m);
  EXPECT_EQ(addDrive(stated, table).raising, report.raising);
}

// Property: one finding is reported, and no mean rises.
TEST(OtherWheel, ReadingsOfAnotherWheelRaiseNothing) {
  const TraversabilityMap before = sand();
  for (const char* column : {"wheel_radius_m", "wheel_width_m", "load_N"}) {
    terramech::Telemetry table = drive();
    if (std::string(column) == "load_N")
      for (auto& numbers : table.numbers) {
        if (numbers.name == "load_N" || numbers.name == "torque_Nm")
          for (double& value : numbers.values) value *= 0.5;
      }
    else
      setColumn(table, column, 1.3 * testRover().wheel.radius_m);
    TraversabilityMap after = sand();
    const DriveReport report = addDrive(after, table);
    EXPECT_EQ(report.raising, 0U) << column;
    EXPECT_EQ(report.others, table.size()) << column;
    EXPECT_EQ(findings(report), 1U) << column;
    EXPECT_EQ(better(before, after), 0) << column;
  }
}

// Property: neither the journal of a light rover nor rows without rover data raise an estimate for a heavy
// rover.
TEST(OtherJournal, JournalOfAnotherRoverRaisesNothing) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("other" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  {
    EvidenceJournal journal((folder / "evidence.db").string()), unnamed((folder / "unnamed.db").string());
    TraversabilityMap light = sand(), again = sand(), nameless = sand();
    const double heavy_kg = 2.5 * testRover().mass_kg;
    const TraversabilityMap before = sand(heavy_kg);
    addDrive(light, measuredTwice(drive()), &journal);
    auto rows = journal.rows(journal.drives()[0]);
    for (JournalRow& row : rows) row.wheel = {};
    unnamed.append(journal.drives()[0], rows);
    TraversabilityMap heavy = sand(heavy_kg);
    EXPECT_EQ(findings(replay(again, journal)), 0U);
    EXPECT_GT(better(sand(), again), 100);
    EXPECT_EQ(findings(replay(heavy, journal)), 1U);
    EXPECT_EQ(better(before, heavy), 0);
    EXPECT_EQ(replay(nameless, unnamed).raising, 0U);
    EXPECT_EQ(better(sand(), nameless), 0);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace other_wheel_test
}  // namespace talus::costmap
