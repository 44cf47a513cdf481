// Whole rovers of four and six wheels, in their own ruts, with one faulty sensor: no heading that was
// refused in a cell becomes allowed. Drives of sound rovers do raise estimates.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <rover_drive.hpp>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace rover_fault_test {

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

}  // namespace rover_fault_test
}  // namespace talus::costmap
