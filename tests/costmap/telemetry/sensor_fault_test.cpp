// Property: drives with one faulty sensor improve no estimate; a sound drive improves estimates.
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <rover_drive.hpp>
#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace sensor_fault_test {

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
  terramech::Telemetry out;
  out.source = "drive.csv";
  const std::vector<std::pair<const char*, double Row::*>> columns{{"time_s", &Row::time_s},
                                                                   {"x_m", &Row::x_m},
                                                                   {"y_m", &Row::y_m},
                                                                   {"heading_rad", &Row::heading_rad},
                                                                   {"slope_rad", &Row::slope_rad},
                                                                   {"slip", &Row::slip},
                                                                   {"torque_Nm", &Row::torque_Nm},
                                                                   {"sinkage_m", &Row::sinkage_m}};
  for (const auto& [name, field] : columns) {
    std::vector<double> values;
    for (const Row& row : rows) values.push_back(row.*field);
    out.numbers.push_back({name, values});
  }
  out.numbers.push_back({"load_N", std::vector<double>(rows.size(), terramech::wheelLoad_N(testRover()))});
  out.words = {{"run", {}}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.lines.push_back(i + 2);
    out.words[0].values.push_back(rows[i].run);
  }
  return out;
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

const double kSilent = std::nan("");

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

// Property: dangerous rows inserted anywhere in a drive improve no estimate beyond that of the drive without
// them.
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
    EXPECT_EQ(raised(without, with), 0) << trial;
  }
}

// Property: two rows of a trap in the middle of a sound drive lower the estimate at their place.
TEST(FaultyDrive, TrapOfTwoRowsLowersTheEstimateDespiteSpikeFilter) {
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
