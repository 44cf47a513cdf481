// An error common to all readings of a rover, for example of slip or ground speed, is not reduced by
// averaging over readings, places or drives.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>

#include <rover_drive.hpp>
#include <site_map.hpp>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/costmap/telemetry/slip_fit.hpp>

namespace talus::costmap {
namespace shared_error_test {

constexpr double kHeight_m = 1.0;
constexpr double kGradient = 0.15;
constexpr maps::Cell kDriven{30, 23}, kClimbed{16, 23}, kBeside{30, 26}, kFar{30, 60};

TraversabilityMap sand() {
  return mapOf(testSand(), 4, kHeight_m);
}

// Test sand with lower strength. The pull is lower than that of the class by 0.12 and 0.23 in the two calls
// below.
terramech::Soil weakerBy(double cohesion_Pa, double friction_rad) {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa -= cohesion_Pa;
  soil.friction_angle_rad -= friction_rad;
  return soil;
}

// A drive without torque whose slip readings of all wheels are too small by a scale and an offset.
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

// Property: slip read too small never makes weak ground safer than before the drive: on the track, beside the
// track, or elsewhere.
TEST(SharedError, UnderreadSlipOfAllWheelsLowersNoRisk) {
  const TraversabilityMap before = sand();
  for (const terramech::Soil& truth : {weakerBy(400.0, 0.1), weakerBy(700.0, 0.2)})
    for (const auto& [scale, shift] : {std::pair(1.0, -0.1), {1.0, -0.2}, {1.0, -0.25}, {0.5, 0.0}}) {
      const TraversabilityMap after = driven(truth, scale, shift);
      for (const maps::Cell cell : {kDriven, kBeside, kFar})
        EXPECT_GE(risk(after, cell), risk(before, cell)) << scale << ' ' << shift << ' ' << cell.row;
    }
}

double pullStd(const TraversabilityMap& map, maps::Cell cell) {
  return map.ground(cell)->pull.std;
}

// Shared error and weight 1/v of a reading at slip s on ground equal to its class. k = H(0.5)/H(s) in [1, 3]
// is the growth of a departure from s to slip 0.5; a reading with a larger k raises no estimate. g' is the
// slope of the mobility curve.
//   m^2 = (0.4 (k - 1) p)^2 + (0.06 (0.5 - s))^2, 0.5 - s at most 0.25: other differences between soils
//   shared^2 = m^2 + of_sensor^2, stored in steps of 1.5 from 0.02 on, rounded up; of_sensor: remaining error
//   of the drive's sensor v = m^2 + k^2 (0.01^2 + 0.02^2 + (0.03 g')^2), its root rounded up to 0.025 2^(i/2)
struct Shared {
  double std, weight;
};

Shared sharedAt(const GroundModel& model, double slip, bool in_rut, double of_sensor) {
  const auto at = [&](double there) { return model.steady(0, {.slip = there, .in_rut = in_rut}); };
  const double thrust = at(slip).torque_over_load_radius;
  const double k = model.reference(0, in_rut).torque_over_load_radius / thrust;
  if (!(k >= 1.0 && k <= 3.0)) return {0.0, 0.0};
  const double by_soil =
      std::hypot(0.4 * (k - 1.0) * model.prior(0).pull.std, 0.06 * std::min(std::abs(0.5 - slip), 0.25));
  double kept = 0.02;
  while (kept < std::hypot(of_sensor, by_soil)) kept *= 1.5;
  const double own = k * std::hypot(0.01, 0.02, 0.5 * (at(slip + 0.03).gradient - at(slip - 0.03).gradient));
  const double grade = std::max(std::ceil(2.0 * std::log2(std::hypot(own, by_soil) / 0.025)), 0.0);
  const double counted = 0.025 * std::exp2(0.5 * grade);
  return {kept, 1.0 / (counted * counted)};
}

// Posterior of the slip sensor of a drive (by SlipFit, which has its own test).
std::shared_ptr<const SlipPosterior> sensorOf(const GroundModel& model, const Drive& drive) {
  SlipFit fit(model);
  for (std::size_t i = 0; i < drive.rows.size(); i += 4) {
    SlipFit::Moment moment{.run = drive.run[i],
                           .rutted = 2,
                           .wheels = 4,
                           .place = {drive.rows[i][kX], drive.rows[i][kY]},
                           .gradient = std::tan(drive.rows[i][kSlope])};
    for (std::size_t w = i; w < i + 4; ++w) moment.slip += 0.25 * drive.rows[w][kSlip];
    fit.take(moment);
  }
  return fit.fitted([](const std::string&) { return 0.0; });
}

// Closed form: many readings reduce the standard deviation m of the class mean to m c / sqrt(m^2 + c^2), c
// being the mean shared error of the drive's readings; the variation between places remains. Gentle hills
// require slips of about 0.1, at which half of a departure or less is measured. Tolerance 2 %.
TEST(SharedError, ClassStdCombinesWithTheSharedErrorAtLowSlip) {
  const TraversabilityMap before = sand();
  TraversabilityMap after = sand();
  const Drive drive = driveOver(after, testSand(), 1, {8.5, 23.5, 38.5});
  addDrive(after, tableOf(drive, false));
  const auto sensor = sensorOf(after.model(), drive);
  ASSERT_LT(std::abs(sensor->slip_bias), 0.01);
  std::map<std::pair<int, int>, std::pair<double, double>>
      blocks;  // blocks of one metre: sum of weights, sum of weighted values
  double shared = 0.0, slip = 0.0;
  for (const auto& row : drive.rows) {
    const Shared read =
        sharedAt(after.model(), row[kSlip] / sensor->slip_scale, row[kPass] > 1.0, sensor->departure[0].std);
    auto& [weight, sum] = blocks[{static_cast<int>(row[kX]), static_cast<int>(row[kY])}];
    weight += read.weight;
    sum += read.weight * read.std;
    slip += row[kSlip] / static_cast<double>(drive.rows.size());
  }
  double told = 0.0;
  for (const auto& [where, of] : blocks)
    if (of.first > 0.0) shared += of.second / of.first, told += 1.0;
  shared /= told;
  ASSERT_LT(slip, 0.15);
  const GroundClass& ground = after.model().parts().classes[0];
  const double of_class = ground.mean_std * shared / std::hypot(ground.mean_std, shared);
  EXPECT_NEAR(pullStd(after, kFar) / std::hypot(ground.pull_std, of_class), 1.0, 0.02);
  EXPECT_LT(pullStd(after, kFar), 0.94 * pullStd(before, kFar));
  EXPECT_LE(pullStd(after, kBeside), pullStd(after, kFar));
  EXPECT_LT(pullStd(after, kDriven), pullStd(after, kBeside));
  EXPECT_LT(pullStd(after, kClimbed), 0.7 * pullStd(before, kClimbed));
}

// Selects from each run some moments on level ground, and those with slips near the reference slip.
Drive nearReferenceSlip(const Drive& whole, std::size_t wheels) {
  constexpr int kLevelMoments = 24;
  Drive out;
  std::string run;
  int level = 0;
  for (std::size_t i = 0; i < whole.rows.size(); i += wheels) {
    if (whole.run[i] != run) level = 0;
    run = whole.run[i];
    const bool flat = std::abs(whole.rows[i][kSlope]) < 0.06 && level < kLevelMoments;
    level += flat ? 1 : 0;
    if (!flat && (whole.rows[i][kSlip] < 0.35 || whole.rows[i][kSlip] > 0.65)) continue;
    for (std::size_t w = i; w < i + wheels; ++w) {
      out.rows.push_back(whole.rows[w]);
      out.run.push_back(whole.run[w]);
      out.wheel.push_back(whole.wheel[w]);
    }
  }
  return out;
}

// Property: a drive with correct slip near the reference slip reduces the standard deviation, more at closer
// places and most where the rover climbed. The tolerances apply to readings without extrapolation in slip.
TEST(SharedError, SoundDriveReducesStdMostWhereItDrove) {
  constexpr double kSteep_m = 1.5;
  const TraversabilityMap before = mapOf(testSand(), 4, kSteep_m);
  TraversabilityMap after = mapOf(testSand(), 4, kSteep_m);
  const Drive whole = driveOver(after, testSand(), 1, {8.5, 8.5, 23.5, 23.5, 38.5, 38.5});
  addDrive(after, tableOf(nearReferenceSlip(whole, 4), false));
  EXPECT_LT(pullStd(after, kClimbed), 0.7 * pullStd(before, kClimbed));
  EXPECT_LT(pullStd(after, kDriven), 0.8 * pullStd(before, kDriven));
  EXPECT_LT(pullStd(after, kDriven), pullStd(after, kBeside));
  EXPECT_LE(pullStd(after, kBeside), pullStd(after, kFar));
  EXPECT_LT(pullStd(after, kFar), 0.92 * pullStd(before, kFar));
}

// Closed form: for any number of drives the standard deviation of the class is at least p c / sqrt(p^2 +
// c^2), with the prior p and the shared error c; without a shared error it can be smaller.
TEST(SharedError, ClassStdIsBoundedBelowBySharedErrorOverManyDrives) {
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

// Property: ground with evidence that is no weaker than its class is at least as certain as undriven ground
// of the class, also if some of the evidence may only lower.
TEST(SharedError, DrivenGroundIsNoLessCertainThanItsClass) {
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

}  // namespace shared_error_test
}  // namespace talus::costmap
