// An error that all readings of a rover share, as of the slip of all wheels or of the speed over ground, is not averaged
// away: by numbers, by places nor by drives.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <rover_drive.hpp>
#include <site_map.hpp>

#include <talus/costmap/class_lessons.hpp>
#include <talus/costmap/drive_evidence.hpp>

namespace talus::costmap {
namespace {

constexpr double kHeight_m = 1.0;
constexpr double kGradient = 0.15;
constexpr maps::Cell kDriven{30, 23}, kClimbed{16, 23}, kBeside{30, 26}, kFar{30, 60};

TraversabilityMap sand() {
  return mapOf(testSand(), 4, kHeight_m);
}

// Sand of a strength that pulls less than the class by 0.12 and by 0.23.
terramech::Soil weakerBy(double cohesion_Pa, double friction_rad) {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa -= cohesion_Pa;
  soil.friction_angle_rad -= friction_rad;
  return soil;
}

// The slip of all wheels is read so much too small; the file has no torque.
TraversabilityMap driven(const terramech::Soil& truth, double scale, double shift) {
  TraversabilityMap map = sand();
  Drive drive = driveOver(map, truth, 1, {8.5, 23.5, 38.5});
  for (auto& row : drive.rows) row[kSlip] = std::max(scale * row[kSlip] + shift, -1.0);
  addDrive(map, tableOf(drive, false));
  return map;
}

float risk(const TraversabilityMap& map, maps::Cell cell) {
  return map.model().state(0, *map.ground(cell), kGradient).risk_per_m;
}

// Property: by a slip that is read too small, weak ground is no safer than before the drive: where it was driven, beside
// that, nor elsewhere.
TEST(SharedError, OfTheSlipOfAllWheelsLowersNoRisk) {
  const TraversabilityMap before = sand();
  for (const terramech::Soil& truth : {weakerBy(400.0, 0.1), weakerBy(700.0, 0.2)})
    for (const auto& [scale, shift] : {std::pair(1.0, -0.1), {1.0, -0.2}, {1.0, -0.25}, {0.5, 0.0}}) {
      const TraversabilityMap after = driven(truth, scale, shift);
      for (const maps::Cell cell : {kDriven, kBeside, kFar})
        EXPECT_GE(risk(after, cell), risk(before, cell)) << scale << ' ' << shift << ' ' << cell.row;
    }
}

// Property: a drive whose slip is right makes ground surer, the more the nearer; most where the rover climbed.
TEST(SharedError, LeavesWhatASoundDriveTells) {
  const TraversabilityMap before = sand(), after = driven(testSand(), 1.0, 0.0);
  const auto std = [](const TraversabilityMap& map, maps::Cell cell) { return map.ground(cell)->pull.std; };
  EXPECT_LT(std(after, kClimbed), 0.7 * std(before, kClimbed));
  EXPECT_LT(std(after, kDriven), 0.8 * std(before, kDriven));
  EXPECT_LT(std(after, kDriven), std(after, kBeside));
  EXPECT_LE(std(after, kBeside), std(after, kFar));
  EXPECT_LT(std(after, kFar), 0.92 * std(before, kFar));
}

// Closed form: however many drives, the class is known no better than p c^2 / (p + c^2), p its prior and c the shared
// error; without one it is.
TEST(SharedError, IsNotAveragedAwayByDrives) {
  for (const double shared : {0.0, 0.045}) {
    TraversabilityMap map = mapOf(std::vector<std::string>(60, std::string(60, '1')));
    const GroundClass& ground = map.model().parts().classes[0];
    for (int row = 0; row < 60; row += 2)
      for (int column = 0; column < 60; column += 2)
        for (int i = 0; i < 20; ++i)
          map.learn({.time_s = 1.0,
                     .place = map.grid().centre({column, row}),
                     .pull = {map.model().prior(0).pull.value, 0.05},
                     .sinkage = {0.0, std::numeric_limits<double>::infinity()},
                     .shared_std = shared,
                     .pull_may_raise = true});
    map.publishAll();
    const double p = ground.mean_std * ground.mean_std, c = shared * shared;
    const double least = std::sqrt(p * c / (p + c)), known = map.evidence().posterior(0).pull.std;
    EXPECT_GE(known, least);
    EXPECT_LT(known, least + 0.01);
    EXPECT_GE(map.ground({30, 30})->pull.std, least);
    EXPECT_LT(map.ground({30, 30})->pull.std, std::max(1.3 * least, 0.02)) << "with the model's own error";
  }
}

// Property: ground with evidence of its own that is no weaker than its class is as sure as ground of the class that
// nobody drove on, or surer; also where some of the evidence may only lower.
TEST(SharedError, LeavesDrivenGroundNoLessSureThanItsClass) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    TraversabilityMap map = mapOf(std::vector<std::string>(60, std::string(60, '1')));
    const double prior = map.model().prior(0).pull.value;
    std::normal_distribution<double> noise(0.0, 0.03);
    const double share = 0.1 * static_cast<double>(seed % 5);
    for (int lane = 0; lane < 5; ++lane)
      for (int i = 0; i < 300; ++i)
        map.learn({.time_s = 1.0 + i,
                   .place = {102.0 + 0.18 * i, 210.0 + 8.0 * lane},
                   .pull = {prior + noise(random), 0.05},
                   .sinkage = {0.0, std::numeric_limits<double>::infinity()},
                   .shared_std = 0.01 * static_cast<double>(random() % 8),
                   .pull_may_raise = std::uniform_real_distribution<double>()(random) >= share});
    map.publishAll();
    const GroundBelief away = map.evidence().classBelief(0);
    ASSERT_LT(away.pull.std, 0.07);
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 60; ++column)
        EXPECT_LE(map.ground({column, row})->pull.std, away.pull.std + 1e-12)
            << seed << ' ' << column << ' ' << row;
  }
}

}  // namespace
}  // namespace talus::costmap
