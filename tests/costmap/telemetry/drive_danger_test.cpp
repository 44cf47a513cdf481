// Evidence of danger in whole drives: a dangerous value in any channel of any row refuses the place of the
// row, regardless of other readings.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <rover_drive.hpp>
#include <site_map.hpp>
#include <unistd.h>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace drive_danger_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Row {
  double time_s, x_m, slip;
  double torque_Nm = kNone, sinkage_m = kNone, slope_rad = kNone, heading_rad = kNone;
  double y_m = 220.5;
  std::string wheel = "w0";
};

terramech::Telemetry tableOf(const std::vector<Row>& rows, const terramech::Rover& rover = testRover()) {
  const double load_N = terramech::wheelLoad_N(rover);
  Drive drive;
  for (const Row& r : rows) {
    drive.rows.push_back(
        {r.time_s, r.x_m, r.y_m, r.heading_rad, r.slope_rad, r.slip, load_N, r.torque_Nm, r.sinkage_m, 1.0});
    drive.wheel.push_back(r.wheel);
  }
  drive.run.resize(rows.size());
  return tableOf(drive);
}

constexpr int kSide = 40;

// Rovers of the tests; the last has the size of Sojourner.
std::vector<terramech::Rover> rovers() {
  terramech::Rover six = testRover(), tiny = testRover();
  six.wheel_count = 6;
  six.mass_kg *= 1.5;
  tiny.wheel_count = 6;
  tiny.mass_kg = 11.0;
  tiny.wheel = {.radius_m = 0.065, .width_m = 0.08};
  tiny.wheelbase_m = 0.6;
  tiny.track_m = 0.5;
  tiny.clearance_m = 0.15;
  tiny.max_torque_Nm = 3.0;
  return {testRover(), six, tiny};
}

TraversabilityMap plain(const terramech::Rover& rover, const terramech::Soil& soil, double rise = 0.0) {
  auto model = std::make_shared<GroundModel>(
      GroundModel::Parts{.rover = rover, .classes = {GroundClass{.number = 1, .soil = soil}}, .policy = {}});
  return TraversabilityMap(drawn(std::vector<std::string>(kSide, std::string(kSide, '1')), rise), model, {});
}

bool refused(const TraversabilityMap& map, const maps::Point& place) {
  const auto grid = map.published();
  for (int k = 0; k < 16; ++k) {
    const double angle = k * std::numbers::pi / 8.0;
    if (!std::isinf(grid->cost().costPerMetre(grid->at(*map.grid().cellAt(place)),
                                              {std::cos(angle), std::sin(angle)})))
      return false;
  }
  return true;
}

// Soil that supports a rover on nearly any slope.
terramech::Soil bedrock() {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = 20000.0;
  soil.frictional_modulus = 5e7;
  return soil;
}

// 60 rows without a fault, then the given rows at x = 125.5.
std::vector<Row> afterGoodRows(const std::vector<Row>& last, bool with_slope) {
  std::vector<Row> rows;
  for (int i = 0; i < 60; ++i) {
    rows.push_back({.time_s = 2.0 * i, .x_m = 105.5 + 0.25 * i, .slip = 0.05 + 0.002 * (i % 7)});
    if (with_slope) rows.back().slope_rad = rows.back().heading_rad = 1e-3 * (i % 5);
  }
  for (Row row : last) {
    row.time_s += 125.0;
    row.x_m = 125.5;
    rows.push_back(row);
  }
  return rows;
}

TEST(Danger, OneDangerousChannelRefusesThePlaceWithOthersMissing) {
  const std::vector<std::vector<Row>> logs{
      {{0, 0, 0.95}, {1, 0, 0.95}},
      {{0, 0, 0.93}, {1, 0, 1.0}},
      {{.time_s = 0, .x_m = 0, .slip = 0.95, .heading_rad = kInfinite}},
      {{.time_s = 0, .x_m = 0, .slip = 0.92, .torque_Nm = -kInfinite, .heading_rad = kNone}},
      {{.time_s = -500, .x_m = 0, .slip = 0.95}},
      {{kNone, 0, 0.95}}};
  for (const terramech::Rover& rover : rovers())
    for (const terramech::Soil& soil : {testSand(), bedrock()})
      for (const bool with_slope : {false, true})
        for (const auto& log : logs) {
          TraversabilityMap map = plain(rover, soil, 0.05);
          ASSERT_FALSE(refused(map, {125.5, 220.5}));
          addDrive(map, tableOf(afterGoodRows(log, with_slope), rover));
          EXPECT_TRUE(refused(map, {125.5, 220.5})) << rover.wheel_count << ' ' << log[0].slip;
          EXPECT_FALSE(refused(map, {115.5, 220.5})) << "ground where nothing was wrong";
        }
}

// Property: on ground without elevation or class, danger refuses the place and everything within the pose
// error, whether or not unknown ground is allowed. The refusal remains after a patch adds the ground, with
// the limits of its class if known.
TEST(Danger, DangerOnUnobservedGroundIsRetainedAfterPatching) {
  for (const bool allow_unknown : {false, true})
    for (const char hole : {'?', '9'})
      for (const bool by_sinkage : {false, true}) {
        std::vector<std::string> rows(kSide, std::string(kSide, '1'));
        rows[kSide - 1 - 20][25] = hole;
        TraversabilityMap map = mapOf(rows, 0.0, {.allow_unknown = allow_unknown});
        const Row spun =
            by_sinkage
                ? Row{.time_s = 0, .x_m = 0, .slip = 0.1, .sinkage_m = 0.9 * testRover().wheel.radius_m}
                : Row{.time_s = 0, .x_m = 0, .slip = 0.95};
        const DriveReport report =
            addDrive(map, tableOf(afterGoodRows({spun, spun}, true)), nullptr, {.pose_std_m = 0.5});
        const auto without_class = testing::Contains(testing::HasSubstr("1 places refused"));
        EXPECT_EQ(testing::Value(report.findings, without_class), hole == '9');
        SurfacePatch patch;
        patch.elevation_m = maps::Raster<float>(
            {.width = 3, .height = 3, .resolution_m = 1.0, .south_west = {124.0, 219.0}}, 1000.0F);
        patch.classes = maps::Raster<std::uint8_t>(patch.elevation_m.grid(), 1);
        for (const bool patched : {false, true}) {
          if (patched) map.patch(patch);
          for (const double x : {124.5, 125.5, 126.5})
            EXPECT_TRUE(refused(map, {x, 220.5})) << hole << patched << x;
          EXPECT_FALSE(refused(map, {115.5, 220.5}));
        }
      }
}

TEST(Danger, DeepSinkageAtLowSlipRefusesThePlace) {
  for (const terramech::Rover& rover : rovers())
    for (const double z : {0.85, 0.9, 1.08, 1.9})
      for (const double slip : {0.1, 0.2}) {
        TraversabilityMap map = plain(rover, testSand());
        std::vector<Row> rows = afterGoodRows({{0, 0, slip}, {1, 0, slip}}, true);
        for (Row& row : rows) row.sinkage_m = 0.1 * rover.wheel.radius_m;
        for (std::size_t i = 60; i < rows.size(); ++i) rows[i].sinkage_m = z * rover.wheel.radius_m;
        addDrive(map, tableOf(rows, rover));
        EXPECT_TRUE(refused(map, {125.5, 220.5})) << z << ' ' << slip;
      }
}

// Property: standing, reversing or a thousand good rows at the same place do not remove a refusal.
TEST(Danger, LaterReadingsDoNotRemoveARefusal) {
  for (const double slip_after : {0.0, -0.1, 0.05}) {
    TraversabilityMap map = plain(testRover(), testSand());
    std::vector<Row> rows = afterGoodRows({{.time_s = 0, .x_m = 0, .slip = 0.95, .slope_rad = 0.0}}, true);
    for (int i = 0; i < 1000; ++i)
      rows.push_back({.time_s = 130.0 + i,
                      .x_m = 125.5,
                      .slip = slip_after + 1e-4 * (i % 11),
                      .slope_rad = 0.0,
                      .heading_rad = 0.0});
    addDrive(map, tableOf(rows));
    EXPECT_TRUE(refused(map, {125.5, 220.5})) << slip_after;
  }
}

// Property: a thousand rows on ground with drawbar pull over load -0.05, on which a wheel spins on level
// ground, do not average to an acceptable mean.
TEST(Danger, ManyDangerousReadingsDoNotAverageOut) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0.0, 0.01);
  TraversabilityMap map = plain(testRover(), testSand());
  std::vector<Row> rows;
  for (int i = 0; i < 1000; ++i)
    rows.push_back({.time_s = 1.0 * i,
                    .x_m = 125.5,
                    .slip = 0.95 + noise(random),
                    .slope_rad = noise(random),
                    .heading_rad = 0.0});
  addDrive(map, tableOf(rows));
  EXPECT_TRUE(refused(map, {125.5, 220.5}));
}

// Property: if one wheel of six meets pits and the others none, every pit is refused, in any order of the
// rows of a moment, and after an outlier.
TEST(Danger, EveryPitOfOneWheelIsRefused) {
  const terramech::Rover rover = rovers()[1];
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<Row> rows;
    std::vector<double> pits;
    for (int i = 0; i < 160; ++i) {
      std::vector<Row> moment;
      for (int w = 0; w < 6; ++w)
        moment.push_back({.time_s = 2.0 * i,
                          .x_m = 104.5 + 0.2 * i,
                          .slip = 0.1 + 0.003 * static_cast<double>(random() % 9),
                          .torque_Nm = 2.0 + 0.01 * static_cast<double>(random() % 9),
                          .sinkage_m = 0.01 + 1e-5 * static_cast<double>(random() % 9),
                          .slope_rad = 0.0,
                          .heading_rad = 0.0,
                          .y_m = 218.5 + (w % 2 == 0 ? 0.0 : 4.0),
                          .wheel = "w" + std::to_string(w)});
      if (i % 40 >= 30 && i % 40 < 32) {
        moment[0].slip = 0.94;
        moment[0].sinkage_m = 0.9 * rover.wheel.radius_m;
        pits.push_back(moment[0].x_m);
      }
      if (i == 10) moment[0].sinkage_m = 0.05;
      if (trial > 0) std::shuffle(moment.begin(), moment.end(), random);
      rows.insert(rows.end(), moment.begin(), moment.end());
    }
    TraversabilityMap map = plain(rover, testSand());
    addDrive(map, tableOf(rows, rover));
    for (const double x_m : pits) EXPECT_TRUE(refused(map, {x_m, 218.5})) << x_m << " in trial " << trial;
  }
}

// Property: a reading that contradicts the other channels refuses its place and lowers no estimate
// elsewhere.
TEST(Danger, SuspectedReadingRefusesOnlyItsPlace) {
  const std::vector<Row> calm = afterGoodRows({}, true), spike = afterGoodRows({{0, 0, 0.95}}, true);
  TraversabilityMap before = plain(testRover(), testSand()), after = plain(testRover(), testSand());
  addDrive(before, tableOf(calm));
  addDrive(after, tableOf(spike));
  EXPECT_TRUE(refused(after, {125.5, 220.5}));
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      if (std::abs(column - 25) <= 3 && std::abs(row - 20) <= 3) continue;
      EXPECT_EQ(before.ground({column, row})->pull.value, after.ground({column, row})->pull.value)
          << column << ' ' << row;
    }
}

// Property: rejected rows with one dangerous value, most with a value that is not a number, bound their
// place.
TEST(Danger, RejectedRowsBoundThePlaceAndAreReplayed) {
  const std::string path = std::filesystem::temp_directory_path() / ("danger" + std::to_string(::getpid()));
  const double radius_m = testRover().wheel.radius_m;
  for (const auto& [slip, sinkage_m, heading_rad] :
       std::vector<std::array<double, 3>>{{kInfinite, 0.01, 0.0},
                                          {kNone, 0.95 * radius_m, 0.0},
                                          {0.1, kInfinite, kNone},
                                          {0.95, kNone, kInfinite},
                                          {1.7, 0.01, 0.0}}) {
    terramech::Telemetry telemetry = tableOf(afterGoodRows({}, true));
    telemetry.rejected = {{99, "a number is not finite"}};
    telemetry.rejected_numbers = {{"x_m", {125.5}},           {"y_m", {220.5}},
                                  {"load_N", {-1.0}},         {"slip", {slip}},
                                  {"sinkage_m", {sinkage_m}}, {"heading_rad", {heading_rad}}};
    TraversabilityMap map = plain(testRover(), testSand()), again = plain(testRover(), testSand());
    {
      EvidenceJournal journal(path);
      const DriveReport report = addDrive(map, telemetry, &journal);
      EXPECT_EQ(report.bounding, 1U) << slip;
      EXPECT_EQ(report.used, 60U) << slip;
      EXPECT_TRUE(refused(map, {125.5, 220.5})) << slip;
      replay(again, journal);
      EXPECT_TRUE(refused(again, {125.5, 220.5})) << slip;
    }
    for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(path + suffix);
  }
}

// A rejected row may have a wrong heading. Its reading is assumed to be straight downhill, so that the place
// is also refused downhill; an uphill reading would not refuse the downhill heading.
TEST(Danger, RejectedRowIsAssumedToBeDownhill) {
  for (const bool rejected : {false, true}) {
    terramech::Telemetry telemetry = tableOf(afterGoodRows({}, true));
    if (rejected) {
      telemetry.rejected = {{99, "load_N = -1"}};
      telemetry.rejected_numbers = {
          {"x_m", {125.5}}, {"y_m", {220.5}}, {"load_N", {-1.0}}, {"slip", {0.85}}, {"heading_rad", {0.0}}};
    } else {
      telemetry = tableOf(afterGoodRows({{.time_s = 0, .x_m = 0, .slip = 0.85, .heading_rad = 0.0}}, false));
    }
    TraversabilityMap map = plain(testRover(), testSand(), 0.15);
    addDrive(map, telemetry);
    const auto grid = map.published();
    const CellCode there = grid->at(*map.grid().cellAt({125.5, 220.5}));
    EXPECT_TRUE(std::isinf(grid->cost().costPerMetre(there, {1.0, 0.0}))) << rejected;
    EXPECT_EQ(std::isinf(grid->cost().costPerMetre(there, {-1.0, 0.0})), rejected);
  }
}

// Property: a dangerous channel refuses its place for any other values of the row: missing, infinite, the
// largest double, plausible or impossible; in rows that the reader rejects and in rows that it accepts.
TEST(Danger, DangerousChannelRefusesThePlaceForAnyOtherValues) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const std::vector<double> any{0.0, kNone, kInfinite, -kInfinite, kMost, -kMost, 1e300, -1e300, 1e-320};
  const std::vector<double> plausible{kNone, 0.0, 1e-14, -1e-14, 1e14, -1e14, 1.5707963, -1.5707963, 3.0};
  std::mt19937_64 random(13);
  const double radius_m = testRover().wheel.radius_m;
  for (int trial = 0; trial < 60; ++trial) {
    const bool rejected = trial % 2 == 0;
    const auto draw = [&] {
      const auto& from = rejected ? any : plausible;
      return from[static_cast<std::size_t>(random() % from.size())];
    };
    const int channel = trial / 2 % 3;
    const std::vector<terramech::Telemetry::Numbers> row{
        {"x_m", {125.5}},
        {"y_m", {220.5}},
        {"slip",
         {channel == 0   ? 0.95
          : channel == 1 ? 0.1
                         : (rejected ? kMost : 1.0)}},
        {"sinkage_m", {channel == 1 ? 0.9 * radius_m : draw()}},
        {"load_N", {rejected ? draw() : (trial % 4 == 1 ? 1e-14 : 1e14)}},
        {"torque_Nm", {draw()}},
        {"slope_rad", {draw()}},
        {"heading_rad", {draw()}},
        {"time_s", {draw()}},
        {"z_m", {draw()}},
        {"pass_index", {draw()}},
        {"pose_std_m", {draw()}},
        {"speed_mps", {draw()}},
        {"rim_speed_mps", {draw()}},
        {"drawbar_pull_N", {draw()}}};
    terramech::Telemetry telemetry = tableOf(afterGoodRows({}, true));
    if (rejected) {
      telemetry.rejected = {{99, "not finite"}};
      telemetry.rejected_numbers = row;
    } else {
      telemetry.lines.push_back(99);
      for (auto& column : telemetry.words) column.values.push_back(column.values.back());
      for (const auto& column : row) {
        auto known = std::find_if(telemetry.numbers.begin(), telemetry.numbers.end(),
                                  [&](const auto& c) { return c.name == column.name; });
        if (known == telemetry.numbers.end())
          known = telemetry.numbers.insert(known, {column.name, std::vector<double>(60, kNone)});
        known->values.push_back(column.values[0]);
      }
    }
    TraversabilityMap map = plain(testRover(), testSand(), 0.05);
    const DriveReport report = addDrive(map, telemetry);
    std::string told = report.first_reason + "; ";
    for (const auto& column : row) told += column.name + " " + std::to_string(column.values[0]) + " ";
    EXPECT_TRUE(refused(map, {125.5, 220.5})) << rejected << ' ' << told;
  }
}

// Two drives over the same ground, one of them faulty: the faulty drive allows nothing that the sound drive
// refused, in either order.

constexpr double kHeight_m = 0.6;  // height of waves whose slopes weak sand supports

TraversabilityMap sand() {
  return mapOf(testSand(), 4, kHeight_m);
}

Drive soundDrive(const TraversabilityMap& map, unsigned seed) {
  Drive drive = driveOver(map, weakSand(), seed);
  for (auto& row : drive.rows) row[kTime] += 1e5 * seed;
  return drive;
}

// Slip of the class on a gradient.
double slipOfClass(const GroundModel& model, double gradient) {
  double low = -0.5, high = 0.9;
  while (high - low > 1e-4) {
    const double slip = 0.5 * (low + high);
    const double pull = 0.5 * (model.steady(0, {slip, false}).drawbar_pull_over_load +
                               model.steady(0, {slip, true}).drawbar_pull_over_load);
    (pull < gradient ? low : high) = slip;
  }
  return low;
}

// Cells and climbs up to 0.35 that are allowed.
std::vector<bool> allowed(const TraversabilityMap& map) {
  std::vector<bool> cells;
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      for (double gradient = 0.05; gradient < 0.35; gradient += 0.005)
        cells.push_back(map.model().state(0, *map.ground({column, row}), gradient).refusal == Refusal::None);
  return cells;
}

// Number of cells that are allowed after both drives, not after the sound drive, and that the true soil does not
// hold at slip 0.8, by more than the error of the model.
int freedWrongly(const TraversabilityMap& both, const TraversabilityMap& sound) {
  constexpr double kModel = 0.02;  // error of the model of a wheel
  const auto truth = groundOf(weakSand(), 4);
  const double most = 0.5 * (truth->steady(0, {.slip = 0.8}).drawbar_pull_over_load +
                             truth->steady(0, {.slip = 0.8, .in_rut = true}).drawbar_pull_over_load);
  int cells = 0;
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      for (double gradient = most + kModel; gradient < 0.3; gradient += 0.01) {
        const auto isAllowed = [&](const TraversabilityMap& map) {
          return map.model().state(0, *map.ground({column, row}), gradient).refusal == Refusal::None;
        };
        cells += isAllowed(both) && !isAllowed(sound) ? 1 : 0;
      }
  return cells;
}

struct Fault {
  const char* name;
  std::function<double(double slip, double other)> read;  // other: slip of the class, or gradient
};

class OneFaultyDrive : public ::testing::TestWithParam<Fault> {};

// Property: a faulty drive behind a sound one allows no cell that the true soil does not hold (three in a thousand cells, as in FaultWorlds); the result is
// bit-identical in either order.
TEST_P(OneFaultyDrive, DoesNotRaiseWhatASoundDriveLowered) {
  TraversabilityMap sound = sand(), both = sand(), turned = sand();
  const Drive first = soundDrive(sound, 1);
  Drive second = soundDrive(sound, 2);
  for (auto& row : second.rows)
    row[kSlip] =
        std::max(GetParam().read(row[kSlip], slipOfClass(sound.model(), std::tan(row[kSlope]))), -1.0);
  addDrive(sound, tableOf(first, false));
  ASSERT_LT(std::ranges::count(allowed(sound), true), std::ranges::count(allowed(sand()), true));
  addDrive(both, tableOf(first, false));
  addDrive(both, tableOf(second, false));
  addDrive(turned, tableOf(second, false));
  addDrive(turned, tableOf(first, false));
  EXPECT_LE(freedWrongly(both, sound), 3 * kRoverSide * kRoverSide / 1000);
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column) {
      const Estimate one = both.ground({column, row})->pull, other = turned.ground({column, row})->pull;
      ASSERT_EQ(one.value, other.value);
      ASSERT_EQ(one.std, other.std);
    }
}

INSTANTIATE_TEST_SUITE_P(Each, OneFaultyDrive,
                         ::testing::Values(Fault{"none", [](double slip, double) { return slip; }},
                                           Fault{"less", [](double slip, double) { return slip - 0.05; }},
                                           Fault{"much_less", [](double slip, double) { return slip - 0.1; }},
                                           Fault{"share", [](double slip, double) { return 0.8 * slip; }},
                                           Fault{"of_the_class", [](double, double of) { return of; }}),
                         [](const auto& each) { return each.param.name; });

// Telemetry of a drive with a second slip.
terramech::Telemetry withSecond(const Drive& drive, const Fault& fault) {
  terramech::Telemetry table = tableOf(drive, false);
  std::vector<double> speed;
  for (const auto& row : drive.rows)
    speed.push_back(0.2 * (1.0 - fault.read(row[kSlip], std::tan(row[kSlope]))));
  table.numbers.push_back({"rim_speed_mps", std::vector<double>(speed.size(), 0.2)});
  table.numbers.push_back({"speed_mps", std::move(speed)});
  return table;
}

class FalseSecondSlip : public ::testing::TestWithParam<Fault> {};

// Property: a false second slip beside a sound first one is named, and allows no climb that the class refuses.
TEST_P(FalseSecondSlip, IsNamedAndAllowsNothing) {
  TraversabilityMap map = sand();
  const std::vector<bool> before = allowed(map);
  const DriveReport report = addDrive(map, withSecond(driveOver(map, testSand(), 1), GetParam()));
  EXPECT_TRUE(std::ranges::any_of(
      report.findings, [](const std::string& line) { return line.find("the second slip is false") == 0; }));
  const std::vector<bool> after = allowed(map);
  for (std::size_t i = 0; i < after.size(); ++i) ASSERT_TRUE(before[i] || !after[i]);
}

INSTANTIATE_TEST_SUITE_P(Each, FalseSecondSlip,
                         ::testing::Values(Fault{"stuck", [](double, double) { return 0.02; }},
                                           Fault{"share", [](double slip, double) { return 0.6 * slip; }},
                                           Fault{"less_uphill",
                                                 [](double slip, double gradient) {
                                                   return gradient > 0.0 ? 0.5 * slip : slip;
                                                 }}),
                         [](const auto& each) { return each.param.name; });

// Property: on a soil that changes with time, decisions count on the newest drive, whichever was added first, and a
// drive that is older than the map's evidence is named; on one that does not change, on both drives.
TEST(ChangingSoil, NewestDriveCountsInEitherOrder) {
  GroundClass ground = groundClass(1, sandPrior(), testRover());
  const TraversabilityMap site(hills(), groundOf(ground), {});
  terramech::Soil wet = testSand();
  wet.friction_angle_rad -= 0.1;
  Drive late = driveOver(site, testSand(), 2);
  for (auto& row : late.rows) row[kTime] += 60.0 * 86400.0;
  const auto first = measuredTwice(tableOf(driveOver(site, wet, 1), false)),
             second = measuredTwice(tableOf(late, false));
  std::vector<std::string> findings;
  const auto counted = [&](double correlation_time_s, const std::vector<terramech::Telemetry>& drives) {
    ground.soil.correlation_time_s = correlation_time_s;
    TraversabilityMap map(hills(), groundOf(ground), {});
    for (const auto& drive : drives) findings = addDrive(map, drive).findings;
    return map.evidence().classBelief(0).pull.value;
  };
  const double alone = counted(86400.0, {second});
  EXPECT_NEAR(counted(86400.0, {first, second}), alone, 0.01);
  EXPECT_NEAR(counted(86400.0, {second, first}), alone, 0.01);
  EXPECT_EQ(findings.back().find("time_s ends 60 days before the newest drive"), 0U) << findings.back();
  EXPECT_LT(counted(0.0, {first, second}), alone - 0.02);
}

std::string bytesOf(const TraversabilityMap& map) {
  std::stringstream stream;
  writeMap(map, stream);
  return stream.str();
}

// Property: the journals of two rovers give the map of all drives, in either order; a drive left out of it or of
// the replay, with the places where its wheels failed, leaves the map of the other drives. All bit for bit.
TEST(DriveAgainstDrive, JournalsJoinAndADriveIsLeftOutBitForBit) {
  const std::string folder = ::testing::TempDir();
  for (const char* name : {"one.db", "other.db"}) std::filesystem::remove(folder + name);
  TraversabilityMap all = sand(), others = sand(), joined = sand(), turned = sand(), replayed = sand();
  EvidenceJournal one(folder + "one.db"), other(folder + "other.db");
  const auto first = tableOf(soundDrive(all, 1), false), third = tableOf(soundDrive(all, 3), false);
  Drive faulty = soundDrive(all, 2);
  for (auto& row : faulty.rows) row[kSlip] -= 0.05;
  faulty.rows[40][kSlip] = faulty.rows.back()[kSlip] = 1.0;
  faulty.rows.back()[kX] = -0.2;  // beyond the edge of the map
  for (const auto& [drive, journal] :
       {std::pair{tableOf(faulty, false), &one}, {first, &one}, {third, &other}})
    addDrive(all, drive, journal);
  ASSERT_FALSE(all.surface().refused().empty());
  for (const auto& drive : {first, third}) addDrive(others, drive);
  for (const auto* journal : {&one, &other}) replay(joined, *journal);
  for (const auto* journal : {&other, &one}) replay(turned, *journal);
  EXPECT_EQ(bytesOf(joined), bytesOf(all));
  EXPECT_EQ(bytesOf(turned), bytesOf(all));
  const std::string id = one.drives()[0];
  for (const auto* journal : {&one, &other}) replay(replayed, *journal, {id});
  EXPECT_EQ(bytesOf(replayed), bytesOf(others));
  all.leaveOut(id);
  all.publish();
  EXPECT_EQ(bytesOf(all), bytesOf(others));
  EXPECT_THROW(all.leaveOut(id), std::invalid_argument);
}

// Property: a slip computed from the class instead of measured is a finding with what settles it, and so is ground
// that a sound drive found weaker than its class.
TEST(DriveAgainstDrive, ComputedSlipAndWeakGroundAreNamed) {
  TraversabilityMap map = sand();
  const auto contains = [](const DriveReport& report, const std::string& text) {
    return std::ranges::any_of(report.findings, [&](const std::string& line) {
      return line.find(text) != std::string::npos &&
             line.find("a second slip settles it") != std::string::npos;
    });
  };
  EXPECT_TRUE(
      contains(addDrive(map, tableOf(soundDrive(map, 1), false)), "below its soil: the ground is weaker"));
  Drive second = soundDrive(map, 2);
  for (auto& row : second.rows) row[kSlip] = slipOfClass(map.model(), std::tan(row[kSlope]));
  const Fault copy{"copy", [](double slip, double) { return slip; }};
  const DriveReport of_class = addDrive(map, withSecond(second, copy));
  EXPECT_TRUE(contains(of_class, "slip is computed from the soil of the class"));
  EXPECT_TRUE(contains(of_class, "that by rim_speed_mps is computed from slip"));
}

// Property: slip that is read too small from half way on raises no estimate, and the finding states the cause
// and what settles it.
TEST(DriveAgainstDrive, SlipBiasFromMidDriveIsNamedAndRaisesNothing) {
  TraversabilityMap map = sand();
  const TraversabilityMap before = sand();
  Drive drive = soundDrive(map, 1);
  for (std::size_t i = drive.rows.size() / 2; i < drive.rows.size(); ++i) drive.rows[i][kSlip] -= 0.1;
  const DriveReport report = addDrive(map, tableOf(drive, false));
  EXPECT_TRUE(std::ranges::any_of(
      report.findings, [](const std::string& line) { return line.find("slip steps on the way") == 0; }));
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      ASSERT_LE(map.ground({column, row})->pull.value, before.ground({column, row})->pull.value);
}

}  // namespace drive_danger_test
}  // namespace talus::costmap
