// Evidence of danger in whole drives: a dangerous value in any channel of any row refuses the place of the
// row, regardless of other readings.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

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
  terramech::Telemetry out;
  out.source = "drive.csv";
  const std::vector<std::pair<const char*, double Row::*>> columns{{"time_s", &Row::time_s},
                                                                   {"x_m", &Row::x_m},
                                                                   {"y_m", &Row::y_m},
                                                                   {"slip", &Row::slip},
                                                                   {"torque_Nm", &Row::torque_Nm},
                                                                   {"sinkage_m", &Row::sinkage_m},
                                                                   {"slope_rad", &Row::slope_rad},
                                                                   {"heading_rad", &Row::heading_rad}};
  for (const auto& [name, field] : columns) {
    std::vector<double> values;
    for (const Row& row : rows) values.push_back(row.*field);
    if (std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); }))
      out.numbers.push_back({name, values});
  }
  out.numbers.push_back({"load_N", std::vector<double>(rows.size(), terramech::wheelLoad_N(rover))});
  out.words = {{"wheel", {}}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.lines.push_back(i + 2);
    out.words[0].values.push_back(rows[i].wheel);
  }
  return out;
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

// Property: the order of rows within a moment changes no cell.
TEST(Danger, ResultIsIndependentOfRowOrderWithinAMoment) {
  const terramech::Rover rover = rovers()[1];
  std::mt19937_64 random(4);
  std::vector<Row> sorted, shuffled;
  for (int i = 0; i < 120; ++i) {
    std::vector<Row> moment;
    for (int w = 0; w < 6; ++w)
      moment.push_back({.time_s = 2.0 * i,
                        .x_m = 108.0 + 0.2 * i + 0.1 * w,
                        .slip = 1e-3 * static_cast<double>(random() % 990),
                        .torque_Nm = 0.01 * static_cast<double>(random() % 900),
                        .sinkage_m = 1e-4 * static_cast<double>(random() % 900),
                        .slope_rad = 0.1,
                        .heading_rad = 0.0,
                        .y_m = 218.5 + 1.1 * w,
                        .wheel = "w" + std::to_string(w)});
    sorted.insert(sorted.end(), moment.begin(), moment.end());
    std::shuffle(moment.begin(), moment.end(), random);
    shuffled.insert(shuffled.end(), moment.begin(), moment.end());
  }
  TraversabilityMap a = plain(rover, testSand()), b = plain(rover, testSand());
  addDrive(a, tableOf(sorted, rover));
  addDrive(b, tableOf(shuffled, rover));
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      EXPECT_EQ(a.ground({column, row})->pull.value, b.ground({column, row})->pull.value);
      EXPECT_EQ(a.published()->at({column, row}), b.published()->at({column, row}));
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
      telemetry.words[0].values.push_back("w0");
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

}  // namespace drive_danger_test
}  // namespace talus::costmap
