// Property: rows of another wheel, load or rover raise no estimate, in a file and in a journal; rows of the
// same rover raise estimates.
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include <rover_drive.hpp>
#include <site_fixture.hpp>
#include <unistd.h>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace sensor_fault_test {

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

// Whole rovers of four and six wheels, in their own ruts, with one faulty sensor: no heading that was
// refused in a cell becomes allowed. Drives of sound rovers do raise estimates.

// Number of cells and headings, uphill or level, refused in `before` and allowed in `after`. Downhill
// headings are not counted: GroundModel brakes less after a drive over weaker ground, and a refused cell may
// become allowed.
int freed(const TraversabilityMap& before, const TraversabilityMap& after) {
  const auto a = before.published(), b = after.published();
  int count = 0;
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4.0;
        const Direction heading{std::cos(angle), std::sin(angle)};
        const maps::Cell cell{column, row};
        if (a->at(cell).dzDx() * heading.x + a->at(cell).dzDy() * heading.y < -0.01) continue;
        count += std::isinf(a->cost().costPerMetre(a->at(cell), heading)) &&
                 !std::isinf(b->cost().costPerMetre(b->at(cell), heading));
      }
  return count;
}

double meanRise(const TraversabilityMap& before, const TraversabilityMap& after) {
  double sum = 0.0;
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      sum += after.ground({column, row})->pull.value - before.ground({column, row})->pull.value;
  return sum / (kRoverSide * kRoverSide);
}

// A fault of one wheel, or of a sensor common to all wheels.
struct RoverFault {
  const char* name;
  std::function<void(Drive&)> make;
};

template <typename Change>
std::function<void(Drive&)> ofWheel(const char* wheel, Change change) {
  return [=](Drive& d) {
    for (std::size_t i = 0; i < d.rows.size(); ++i)
      if (d.wheel[i] == wheel) change(d.rows[i], i);
  };
}

template <typename Change>
std::function<void(Drive&)> ofAll(Change change) {
  return [=](Drive& d) {
    for (std::size_t i = 0; i < d.rows.size(); ++i) change(d.rows[i], i);
  };
}

std::function<void(Drive&)> ofWheels(const std::string& wheels, double scale) {
  return [=](Drive& d) {
    for (std::size_t i = 0; i < d.rows.size(); ++i)
      if (wheels.find(d.wheel[i]) != std::string::npos) d.rows[i][kSlip] *= scale;
  };
}

std::function<void(Drive&)> without(const char* wheel, std::size_t from) {
  return [=](Drive& d) {
    Drive kept;
    for (std::size_t i = 0; i < d.rows.size(); ++i) {
      if (i >= from && d.wheel[i] == wheel) continue;
      kept.rows.push_back(d.rows[i]);
      kept.run.push_back(d.run[i]);
      kept.wheel.push_back(d.wheel[i]);
    }
    d = kept;
  };
}

const double kSilent = std::nan("");

const std::vector<RoverFault>& faults() {
  using Row = std::vector<double>;
  static const std::vector<RoverFault> all{
      {"none", ofAll([](Row&, std::size_t) {})},
      {"one_slip_stuck", ofWheel("w1", [](Row& r, std::size_t) { r[kSlip] = 0.02; })},
      {"one_slip_stuck_and_noisy", ofWheel("w0",
                                           [](Row& r, std::size_t i) {
                                             r[kSlip] = 0.03 + 0.002 * std::sin(7.0 * static_cast<double>(i));
                                           })},
      {"one_slip_biased",
       ofWheel("w2", [](Row& r, std::size_t) { r[kSlip] = std::max(r[kSlip] - 0.2, -1.0); })},
      {"half_of_the_slips_too_small", ofWheels("w0 w2 w4", 0.3)},
      {"most_slips_too_small", ofWheels("w0 w1 w2 w4", 0.3)},
      {"most_slips_too_small_in_turns",
       ofAll([](Row& r, std::size_t i) { r[kSlip] *= (i + i / 60) % 3 == 0 ? 1.0 : 0.3; })},
      {"all_slips_biased", ofAll([](Row& r, std::size_t) { r[kSlip] = std::max(r[kSlip] - 0.1, -1.0); })},
      {"all_slips_stuck",
       ofAll([](Row& r, std::size_t i) { r[kSlip] = 0.04 + 1e-3 * static_cast<double>(i % 5); })},
      {"all_slips_stick_half_way", ofAll([](Row& r, std::size_t i) {
         r[kSlip] = i % 720 > 360 ? 0.04 + 1e-3 * static_cast<double>(i % 5) : r[kSlip];
       })},
      {"one_wheel_silent", without("w3", 0)},
      {"one_wheel_falls_silent", without("w3", 500)},
      {"one_slip_silent", ofWheel("w1", [](Row& r, std::size_t) { r[kSlip] = kSilent; })},
      {"one_torque_high", ofWheel("w0", [](Row& r, std::size_t) { r[kTorque] += 0.3 * r[kLoad] * 0.12; })},
      {"one_torque_stuck", ofWheel("w0", [](Row& r, std::size_t) { r[kTorque] = 0.5 * r[kLoad] * 0.12; })},
      {"one_sinkage_datum",
       ofWheel("w2", [](Row& r, std::size_t) { r[kSinkage] = std::max(r[kSinkage] - 0.02, 0.0); })},
      {"all_sinkages_0", ofAll([](Row& r, std::size_t) { r[kSinkage] = 0.0; })},
      {"slope_biased", ofAll([](Row& r, std::size_t) { r[kSlope] += 0.08; })},
      {"slope_stuck", ofAll([](Row& r, std::size_t) { r[kSlope] = 0.28; })},
      {"slope_silent", ofAll([](Row& r, std::size_t) { r[kSlope] = kSilent; })},
      {"heading_reversed", ofAll([](Row& r, std::size_t) { r[kHeading] = std::numbers::pi - r[kHeading]; })},
      {"load_half", ofAll([](Row& r, std::size_t) { r[kLoad] *= 0.5; })},
      {"pose_jumps", ofAll([](Row& r, std::size_t i) { r[kY] += i % 720 > 400 ? 9.0 : 0.0; })},
  };
  return all;
}

class OneFaultyRoverSensor : public ::testing::TestWithParam<RoverFault> {};

// Property: if the ground is as weak as its class or weaker, a faulty sensor makes no cell allowed.
TEST_P(OneFaultyRoverSensor, FaultyRoverSensorRaisesNothing) {
  for (const int wheels : {4, 6})
    for (const terramech::Soil& truth : {weakSand(), weakerSand()}) {
      const TraversabilityMap before = mapOf(weakSand(), wheels);
      TraversabilityMap after = mapOf(weakSand(), wheels);
      Drive drive = driveOver(before, truth, static_cast<unsigned>(wheels));
      GetParam().make(drive);
      addDrive(after, tableOf(drive));
      EXPECT_EQ(freed(before, after), 0) << wheels << " wheels, friction " << truth.friction_angle_rad;
    }
}

INSTANTIATE_TEST_SUITE_P(Each, OneFaultyRoverSensor, ::testing::ValuesIn(faults()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(SoundRover, SoundDriveRaisesEstimatesOnFirmerGround) {
  for (const int wheels : {4, 6}) {
    const TraversabilityMap before = mapOf(weakSand(), wheels);
    TraversabilityMap after = mapOf(weakSand(), wheels);
    const DriveReport report = addDrive(after, measuredTwice(tableOf(driveOver(before, testSand(), 1))));
    EXPECT_GT(report.raising, report.used / 4);
    EXPECT_GT(meanRise(before, after), 0.01);
    EXPECT_GT(freed(before, after), 0) << "slopes that weak sand does not hold";
  }
}

TEST(SoundRover, SoundDriveLowersEstimatesOnWeakerGround) {
  const TraversabilityMap before = mapOf(testSand(), 6);
  TraversabilityMap after = mapOf(testSand(), 6);
  addDrive(after, tableOf(driveOver(before, weakerSand(), 1)));
  EXPECT_LT(meanRise(before, after), -0.01);
  EXPECT_EQ(freed(before, after), 0);
}

// Property: drives with one faulty sensor improve no estimate; a sound drive improves estimates.

// Ground stronger than the class by about the variation between classes.
terramech::Soil firmerSand() {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = 1200.0;
  soil.friction_angle_rad = 0.68;
  return soil;
}

constexpr int kSide = 80;

// Waves with slopes up to 15 degrees that vary between places; class 2 in the east.
TraversabilityMap hills() {
  MapLayers layers;
  const maps::Grid grid{.width = kSide, .height = kSide, .resolution_m = 1.0, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(1.6 * std::sin(0.17 * column) + 1.1 * std::sin(0.13 * row));
      if (column >= 55) layers.classes[{column, row}] = 2;
    }
  return TraversabilityMap(std::move(layers), testGround(), {});
}

struct Row {
  double time_s, x_m, y_m, heading_rad, slope_rad, slip, torque_Nm, sinkage_m;
  std::string run;
};

// A drive east along three lines on one soil, a row every quarter of a metre, with the noise of good
// sensors.
std::vector<Row> driveOver(const TraversabilityMap& map, const terramech::Soil& soil) {
  const terramech::SlopeEquilibrium equilibrium(soil, testRover());
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise;
  std::vector<Row> rows;
  for (const double y_m : {10.5, 30.5, 60.5})
    for (int i = 0; i < 180; ++i) {
      const double x_m = 5.0 + 0.25 * i;
      const double gradient = map.published()->at(*map.grid().cellAt({x_m, y_m})).dzDx();
      const terramech::SlopeState s = equilibrium.at({gradient, 0.0});
      rows.push_back({2.5 * i, x_m, y_m, 0.0, std::atan(gradient) + 0.005 * noise(random),
                      s.slip + 0.01 * noise(random), s.torque_Nm * (1.0 + 0.02 * noise(random)),
                      s.sinkage_m * (1.0 + 0.02 * noise(random)), "y" + std::to_string(y_m)});
    }
  return rows;
}

std::vector<Row> soundDrive(const TraversabilityMap& map) {
  return driveOver(map, firmerSand());
}

terramech::Telemetry tableOf(const std::vector<Row>& rows) {
  const double load_N = terramech::wheelLoad_N(testRover());
  Drive drive;
  for (const Row& r : rows) {
    drive.rows.push_back(
        {r.time_s, r.x_m, r.y_m, r.heading_rad, r.slope_rad, r.slip, load_N, r.torque_Nm, r.sinkage_m, 1.0});
    drive.run.push_back(r.run);
  }
  drive.wheel.assign(rows.size(), "w0");
  return tableOf(drive);
}

// Number of cells whose estimate rose by more than rounding, in mean or tail.
int raised(const TraversabilityMap& before, const TraversabilityMap& after) {
  int cells = 0;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const Estimate a = before.ground({column, row})->pull, b = after.ground({column, row})->pull;
      cells += b.value > a.value + 1e-9 || b.value - 3.0 * b.std > a.value - 3.0 * a.std + 1e-9;
    }
  return cells;
}

TEST(FaultyDrive, SoundDriveOverSeveralPlacesRaisesEstimates) {
  const TraversabilityMap before = hills();
  TraversabilityMap after = hills();
  const DriveReport report = addDrive(after, measuredTwice(tableOf(soundDrive(before))));
  EXPECT_EQ(report.used, 540U);
  EXPECT_GT(report.raising, 100U);
  EXPECT_GT(raised(before, after), 200);
  EXPECT_GT(after.ground({37, 30})->pull.value, before.ground({37, 30})->pull.value + 0.02);
}

struct Fault {
  const char* name;
  std::function<void(std::vector<Row>&)> make;
};

class SensorFault : public ::testing::TestWithParam<Fault> {};

TEST_P(SensorFault, FaultySensorRaisesNothing) {
  const TraversabilityMap before = hills();
  TraversabilityMap after = hills();
  std::vector<Row> rows = soundDrive(before);
  GetParam().make(rows);
  addDrive(after, tableOf(rows));
  EXPECT_EQ(raised(before, after), 0);
}

INSTANTIATE_TEST_SUITE_P(One, SensorFault,
                         ::testing::Values(Fault{"heading_silent",
                                                 [](auto& rows) {
                                                   for (Row& r : rows) r.heading_rad = kSilent;
                                                 }},
                                           Fault{"pose_stuck",
                                                 [](auto& rows) {
                                                   for (Row& r : rows) r.x_m = 20.0;
                                                 }},
                                           Fault{"one_place",
                                                 [](auto& rows) {
                                                   rows.resize(5);
                                                   for (Row& r : rows) r.x_m = rows[0].x_m;
                                                 }}),
                         [](const auto& one) { return std::string(one.param.name); });

// Property: a slip bias of any size improves no estimate beyond its previous value or the value of a sound
// sensor.
TEST(FaultyDrive, SlipBiasRaisesNothingBeyondASoundSensor) {
  const TraversabilityMap before = hills();
  for (const terramech::Soil& soil : {firmerSand(), testSand()})
    for (const double bias : {-0.2, -0.08, -0.03, 0.05}) {
      std::vector<Row> rows = driveOver(before, soil);
      TraversabilityMap sound = hills(), biased = hills();
      addDrive(sound, tableOf(rows));
      for (Row& r : rows) r.slip += bias;
      addDrive(biased, tableOf(rows));
      double most = -1.0;
      for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column)
          most = std::max(most, biased.ground({column, row})->pull.value -
                                    std::max(sound.ground({column, row})->pull.value,
                                             before.ground({column, row})->pull.value));
      EXPECT_LE(most, 0.02) << bias << ": beyond the error of the model, the least that a place is known by";
    }
}

// Property: torque and sinkage sensors alone raise no estimate beyond that from slip and slope.
TEST(FaultyDrive, TorqueAndSinkageAloneRaiseNothing) {
  const TraversabilityMap before = hills();
  for (const double torque : {1.3, 1.0, 0.0})
    for (const double sinkage : {1.0, 0.2, 0.0}) {
      std::vector<Row> rows = soundDrive(before), without = rows;
      for (Row& r : rows) {
        r.torque_Nm *= torque;
        r.sinkage_m *= sinkage;
      }
      for (Row& r : without) r.torque_Nm = r.sinkage_m = kSilent;
      TraversabilityMap faulty = hills(), plain = hills();
      addDrive(faulty, tableOf(rows));
      addDrive(plain, tableOf(without));
      if (torque == 1.0 && sinkage == 1.0) continue;
      double most = -1.0;
      for (int column = 0; column < kSide; ++column)
        most =
            std::max(most, faulty.ground({column, 30})->pull.value - plain.ground({column, 30})->pull.value);
      EXPECT_LT(most, 0.02) << torque << ' ' << sinkage;
    }
}

// Property: dangerous rows inserted anywhere in a drive raise no estimate above that of the drive without them.
TEST(FaultyDrive, DangerousRowsRaiseNothing) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int trial = 0; trial < 3; ++trial) {
    TraversabilityMap without = hills(), with = hills();
    std::vector<Row> rows = soundDrive(without);
    addDrive(without, tableOf(rows));
    for (int i = 0; i < 8; ++i) {
      const auto at = static_cast<std::ptrdiff_t>(random() % (rows.size() - 1));
      Row danger = rows[static_cast<std::size_t>(at)];
      danger.time_s += 1.0;
      if (i % 2 == 0)
        danger.slip = 0.75 + 0.25 * share(random);
      else
        danger.sinkage_m = (0.6 + 0.4 * share(random)) * testRover().wheel.radius_m;
      rows.insert(rows.begin() + at + 1, danger);
    }
    addDrive(with, tableOf(rows));
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column)
        ASSERT_LE(with.ground({column, row})->pull.value, without.ground({column, row})->pull.value + 1e-9)
            << trial;
  }
}

// Property: two rows of a trap in the middle of a sound drive lower the estimate at their place.
TEST(FaultyDrive, TrapOfTwoRowsLowersTheEstimate) {
  TraversabilityMap before = hills(), after = hills();
  std::vector<Row> rows = soundDrive(before);
  addDrive(before, tableOf(rows));
  for (const std::size_t i : {90U, 91U}) {
    rows[i].slip = 0.93;
    rows[i].sinkage_m = 0.54 * testRover().wheel.radius_m;
  }
  const DriveReport report = addDrive(after, tableOf(rows));
  EXPECT_EQ(report.used, 540U);
  const maps::Cell cell = *after.grid().cellAt({rows[90].x_m, rows[90].y_m});
  EXPECT_LT(after.ground(cell)->pull.value, before.ground(cell)->pull.value - 0.1);
  EXPECT_GT(after.ground(cell)->sinkage.value, 0.4);
}

// Property: a sinkage of 0.85 r at low slip lowers the estimate, although it contradicts the slope and may
// result from a wrong datum of the sinkage.
TEST(FaultyDrive, DeepSinkageAtLowSlipLowersTheEstimate) {
  const TraversabilityMap before = hills();
  TraversabilityMap after = hills();
  std::vector<Row> rows = soundDrive(before);
  for (Row& r : rows) r.sinkage_m = 0.85 * testRover().wheel.radius_m;
  addDrive(after, tableOf(rows));
  EXPECT_GT(after.ground({30, 30})->sinkage.value, 0.6);
  EXPECT_EQ(raised(before, after), 0);
}

}  // namespace sensor_fault_test
}  // namespace talus::costmap
