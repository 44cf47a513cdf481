// Whole rovers of four and six wheels, in their own ruts, with one faulty sensor: no ground that was refused in some
// direction becomes allowed in it. Sound rovers do learn.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include <site_fixture.hpp>

#include <talus/costmap/drive_evidence.hpp>

namespace talus::costmap {
namespace {

constexpr int kSide = 72;

std::shared_ptr<const GroundModel> groundOf(const terramech::Soil& first, int wheels) {
  terramech::Rover rover = testRover();
  rover.wheel_count = wheels;
  rover.mass_kg *= wheels / 4.0;
  return std::make_shared<GroundModel>(GroundModel::Parts{
      .rover = rover,
      .classes = {GroundClass{.number = 1, .soil = first}, GroundClass{.number = 2, .soil = testSand()}},
      .policy = {}});
}

// Slopes up to 17 degrees: some of them too steep for weak sand.
MapLayers hills() {
  MapLayers layers;
  const maps::Grid grid{.width = kSide, .height = kSide, .resolution_m = 1.0, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(1.5 * std::sin(0.19 * column) + 0.8 * std::sin(0.11 * row));
  return layers;
}

TraversabilityMap mapOf(const terramech::Soil& soil, int wheels) {
  return TraversabilityMap(hills(), groundOf(soil, wheels), {});
}

struct Drive {
  std::vector<std::vector<double>>
      rows;  // time_s x_m y_m heading_rad slope_rad slip load_N torque_Nm sinkage_m pass
  std::vector<std::string> run, wheel;
};
enum Column { kTime, kX, kY, kHeading, kSlope, kSlip, kLoad, kTorque, kSinkage, kPass };

terramech::Telemetry tableOf(const Drive& drive) {
  terramech::Telemetry out;
  out.source = "rover.csv";
  const char* const names[] = {"time_s", "x_m",    "y_m",       "heading_rad", "slope_rad",
                               "slip",   "load_N", "torque_Nm", "sinkage_m",   "pass_index"};
  for (std::size_t c = 0; c < std::size(names); ++c) {
    out.numbers.push_back({names[c], {}});
    for (const auto& row : drive.rows) out.numbers.back().values.push_back(row[c]);
  }
  out.words = {{"run", drive.run}, {"wheel", drive.wheel}};
  for (std::size_t i = 0; i < drive.rows.size(); ++i) out.lines.push_back(i + 2);
  return out;
}

// Along lines of the map, to and fro, on one soil: all wheels slip alike, so that together they pull what the slope
// takes, as far as the soil can.
Drive driveOver(const TraversabilityMap& map, const terramech::Soil& soil, unsigned seed) {
  const terramech::Rover& rover = map.model().rover();
  const auto truth = groundOf(soil, rover.wheel_count);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  const int axles = rover.wheel_count / 2;
  const auto pullAt = [&](double slip) {
    return (truth->steady(0, {slip, false}).gradient +
            (axles - 1) * truth->steady(0, {slip, true}).gradient) /
           axles;
  };
  Drive out;
  int line = 0;
  for (const double y_m : {8.5, 33.5, 58.5}) {
    const double way = line++ % 2 == 0 ? 1.0 : -1.0;
    for (int i = 0; i < 180; ++i) {
      const double x_m = 36.0 + way * (0.35 * i - 31.0);
      const double gradient = way * map.code(*map.grid().cellAt({x_m, y_m})).dzDx();
      double low = -0.5, high = 0.95;
      while (high - low > 1e-4) (pullAt(0.5 * (low + high)) < gradient ? low : high) = 0.5 * (low + high);
      const double slip = low + 0.015 * noise(random);
      for (int w = 0; w < rover.wheel_count; ++w) {
        const int axle = w / 2;
        const SteadyWheel s = truth->steady(0, {low, axle > 0});
        const double load_N = terramech::wheelLoad_N(rover), radius_m = rover.wheel.radius_m;
        out.rows.push_back({2.0 * i, x_m + way * (0.4 - 0.8 * axle / (axles - 1)),
                            y_m + (w % 2 == 0 ? 0.3 : -0.3), way > 0.0 ? 0.0 : std::numbers::pi,
                            std::atan(gradient) + 0.005 * noise(random), slip + 0.005 * noise(random), load_N,
                            s.torque_over_load_radius * load_N * radius_m * (1.0 + 0.03 * noise(random)),
                            s.sinkage_over_radius * radius_m * (1.0 + 0.03 * noise(random)), axle + 1.0});
        out.run.push_back("line" + std::to_string(line));
        out.wheel.push_back("w" + std::to_string(w));
      }
    }
  }
  return out;
}

// Sand that does not hold the steeper slopes, and some that holds less.
terramech::Soil weakSand() {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = 300.0;
  soil.friction_angle_rad = 0.52;
  soil.frictional_modulus = 500000.0;
  return soil;
}

terramech::Soil weakerSand() {
  terramech::Soil soil = weakSand();
  soil.friction_angle_rad = 0.45;
  return soil;
}

// Cells and headings, up a slope or along it, that were refused and are allowed now. (Downhill a drive over weaker
// ground brakes less by the model of GroundModel, and may be allowed for it.)
int freed(const TraversabilityMap& before, const TraversabilityMap& after) {
  const auto a = before.published(), b = after.published();
  int count = 0;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
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
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      sum += after.ground({column, row})->pull.value - before.ground({column, row})->pull.value;
  return sum / (kSide * kSide);
}

// Of one wheel, or of what all wheels share.
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

// Property: the ground is as weak as its class or weaker, and the map knows its class: nothing is freed.
TEST_P(OneFaultyRoverSensor, FreesNothing) {
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

TEST(SoundRover, LearnsThatGroundIsFirmer) {
  for (const int wheels : {4, 6}) {
    const TraversabilityMap before = mapOf(weakSand(), wheels);
    TraversabilityMap after = mapOf(weakSand(), wheels);
    const DriveReport report = addDrive(after, tableOf(driveOver(before, testSand(), 1)));
    EXPECT_GT(report.raising, report.used / 4);
    EXPECT_GT(meanRise(before, after), 0.01);
    EXPECT_GT(freed(before, after), 0) << "slopes that weak sand does not hold";
  }
}

TEST(SoundRover, LearnsThatGroundIsWeaker) {
  const TraversabilityMap before = mapOf(testSand(), 6);
  TraversabilityMap after = mapOf(testSand(), 6);
  addDrive(after, tableOf(driveOver(before, weakerSand(), 1)));
  EXPECT_LT(meanRise(before, after), -0.01);
  EXPECT_EQ(freed(before, after), 0);
}

}  // namespace
}  // namespace talus::costmap
