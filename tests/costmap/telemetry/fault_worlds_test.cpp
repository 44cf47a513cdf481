// Worlds on soils drawn from the class, in which faulty drives follow none, sound and gentle drives, with one slip, a
// second one, one computed from the first, or a second one that has the fault instead; counts the cells that become
// allowed wrongly and rightly, and refused
// needlessly, and the errors of the strength that each drive teaches. TALUS_FAULT_WORLDS="FIRST COUNT" replaces the worlds of each run; a
// campaign consists of such runs.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <campaign_part.hpp>
#include <rover_drive.hpp>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace fault_worlds_test {

constexpr int kSide = 48, kWheels = 4;

// Mean pull of all wheels, half of them in ruts, on ground with a given departure from its soil at slip 0.5.
class Pull {
 public:
  explicit Pull(const GroundModel& soil) {
    const double thrust = soil.reference(0, false).torque_over_load_radius;
    for (int i = 0; i <= kSteps; ++i) {
      const double slip = kLeast + kStep * i;
      const SteadyWheel fresh = soil.steady(0, {.slip = slip}),
                        rut = soil.steady(0, {.slip = slip, .in_rut = true});
      pull_.push_back(0.5 * (fresh.drawbar_pull_over_load + rut.drawbar_pull_over_load));
      share_.push_back(
          std::max(0.5 * (fresh.torque_over_load_radius + rut.torque_over_load_radius) / thrust, 0.0));
    }
  }
  double at(double slip, double departure) const {
    const double place = std::clamp((slip - kLeast) / kStep, 0.0, kSteps - 1e-9);
    const auto i = static_cast<std::size_t>(place);
    const auto of = [&](std::size_t k) { return pull_[k] + departure * share_[k]; };
    return of(i) + (place - static_cast<double>(i)) * (of(i + 1) - of(i));
  }
  double slipOn(double gradient, double departure) const {
    double low = kLeast, high = 0.95;
    while (high - low > 1e-4) {
      const double slip = 0.5 * (low + high);
      (at(slip, departure) < gradient ? low : high) = slip;
    }
    return low;
  }

 private:
  static constexpr int kSteps = 290;
  static constexpr double kLeast = -0.5, kStep = 0.005;
  std::vector<double> pull_, share_;
};

// All properties of one world, determined by its seed.
class World {
 public:
  explicit World(unsigned seed) : random_(seed) {
    height_m_ = uniform(0.4, 1.2);
    GroundClass ground = groundClass(1, sandPrior(), testRover());
    ground.soil = drawnSand(random_);
    const auto model = groundOf(ground);
    truth_.emplace(*model);
    strength_ = model->reference(0, false).drawbar_pull_over_load;
    variation_ = uniform(0.0, 0.05);
    for (int i = 0; i < 6; ++i) phases_.push_back(uniform(0.0, 2.0 * std::numbers::pi));
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double noise() { return normal_(random_); }

  MapLayers layers() const {
    MapLayers out;
    const maps::Grid grid{.width = kSide, .height = kSide, .resolution_m = 1.0, .south_west = {}};
    out.elevation.elevation_m = maps::Raster<float>(grid);
    out.classes = maps::Raster<std::uint8_t>(grid, 1);
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column)
        out.elevation.elevation_m[{column, row}] = static_cast<float>(
            height_m_ * (0.6 + 0.4 * column / kSide) * std::sin(0.25 * column) + 0.4 * std::sin(0.13 * row));
    return out;
  }

  // Departure of the drawbar pull over load at a place from the soil of the world at slip 0.5: waves of
  // several metres.
  double departure(const maps::Point& at) const {
    return variation_ * (std::sin(0.9 * at.x_m + phases_[0]) * std::sin(0.8 * at.y_m + phases_[1]) +
                         std::sin(0.5 * at.x_m + phases_[2]) * std::sin(0.6 * at.y_m + phases_[3]));
  }
  double strength() const { return strength_; }
  double slip(double gradient, const maps::Point& at) const {
    return truth_->slipOn(gradient, departure(at));
  }
  bool holds(const maps::Point& at, double gradient) const {
    return truth_->at(0.8, departure(at)) >= gradient;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double height_m_ = 0.0, variation_ = 0.0, strength_ = 0.0;
  std::optional<Pull> truth_;
  std::vector<double> phases_;
};

// Reading common to all wheels of a moment.
struct Read {
  int line;
  double heading_rad, time_s, x_m, y_m, slope_rad, slip, second;
};
enum class Second { None, Independent, Copied, False };

const char* const kFaults[] = {"none",         "offset",      "scale",      "step",        "stuck",
                               "of_class",     "delay",       "pose_jump",  "pose_offset", "time_step",
                               "slope_offset", "slope_scale", "all_stuck",  "divided",     "uphill",
                               "one_wheel",    "compressed",  "less_uphill"};

// Applies a sensor fault to the telemetry of a drive.
void spoil(const std::string& fault, std::vector<Read>& drive, World& world, const Pull& of_class) {
  const std::vector<Read> sound = drive;
  const double amount = world.uniform(-0.2, 0.2), scale = world.uniform(0.4, 1.3),
               steeper = world.uniform(0.5, 2.0), knee = std::abs(amount) + 0.1;
  const auto from = static_cast<std::size_t>(world.uniform(0.1, 0.9) * static_cast<double>(drive.size()));
  const auto late = static_cast<std::size_t>(world.uniform(1.0, 12.0));
  for (std::size_t i = 0; i < drive.size(); ++i) {
    Read& read = drive[i];
    if (fault == "offset" || (fault == "step" && i >= from)) read.slip += amount;
    if (fault == "scale") read.slip *= scale;
    if (fault == "stuck" && i >= from) read.slip = sound[from].slip;
    if (fault == "of_class") read.slip = of_class.slipOn(std::tan(read.slope_rad), 0.0);
    if (fault == "delay") read.slip = sound[i - std::min(i, late)].slip;
    if (fault == "pose_offset" || (fault == "pose_jump" && i >= from)) read.y_m += 20.0 * amount;
    if (fault == "slope_offset") read.slope_rad += 0.5 * amount;
    if (fault == "slope_scale") read.slope_rad *= steeper;
    if (fault == "time_step" && i >= from) read.time_s += 2500.0 * amount;
    if (fault == "all_stuck") read.slip = 0.1 + 0.5 * amount;
    if (fault == "divided") read.slip *= 0.01;
    if (fault == "uphill" && read.slope_rad > 0.0) read.slip *= 0.5 * scale;
    if (fault == "compressed") read.slip -= (1.0 - 0.5 * scale) * std::max(read.slip - knee, 0.0);
    if (fault == "less_uphill") read.slip -= std::max(steeper * read.slope_rad, 0.0);
    read.slip = std::clamp(read.slip, -1.0, 1.0);
  }
}

// A drive along three lines over the waves; a gentle drive follows crests and troughs, on slopes up to 0.05. Adds the
// cells that the rover climbed at a slip below 0.6, each with the steepest gradient.
terramech::Telemetry driven(World& world, const Pull& of_class, const TraversabilityMap& map,
                            const std::string& fault, Second second, int number, bool gentle,
                            std::map<std::size_t, double>& climbed) {
  Drive out;
  std::vector<double> speed;
  const double load_N = terramech::wheelLoad_N(map.model().rover());
  const double one_wheel = fault == "one_wheel" ? world.uniform(-0.3, 0.3) : 0.0;
  std::vector<Read> drive;
  for (int line = 0; line < 3; ++line) {
    const double way = line % 2 == 0 ? 1.0 : -1.0;
    const double beside_m = gentle ? 6.8 + 12.57 * line : 8.5 + 14.0 * line + world.uniform(-2.0, 2.0);
    const double heading_rad = (gentle ? 0.5 : 0.0) * std::numbers::pi + (way > 0.0 ? 0.0 : std::numbers::pi);
    for (int i = 0; i < 90; ++i) {
      const double along_m = 24.0 + way * (0.47 * i - 20.7);
      const maps::Point at = gentle ? maps::Point{beside_m, along_m} : maps::Point{along_m, beside_m};
      const auto cell = map.published()->at(*map.grid().cellAt(at));
      const double gradient = std::cos(heading_rad) * cell.dzDx() + std::sin(heading_rad) * cell.dzDy();
      const double slip = world.slip(gradient, at);
      if (gradient > 0.0 && slip < 0.6) {
        double& steepest = climbed[map.grid().index(*map.grid().cellAt(at))];
        steepest = std::max(steepest, gradient);
      }
      drive.push_back({line, heading_rad, 1e5 * number + 1e4 * line + 2.0 * i, at.x_m, at.y_m,
                       std::atan(gradient) + 0.005 * world.noise(), slip + 0.015 * world.noise(),
                       slip + 0.02 * world.noise()});
    }
  }
  const auto exchange = [&] {
    for (Read& read : drive) std::swap(read.slip, read.second);
  };
  if (second == Second::False) exchange();
  spoil(fault, drive, world, of_class);
  if (second == Second::False) exchange();
  for (const Read& read : drive)
    for (int w = 0; w < kWheels; ++w) {
      const double slip =
          std::clamp(read.slip + 0.005 * world.noise() + (w == 1 ? one_wheel : 0.0), -1.0, 1.0);
      const double ahead_m = w < 2 ? 0.4 : -0.4, left_m = w % 2 == 0 ? 0.3 : -0.3;
      const double east = std::cos(read.heading_rad), north = std::sin(read.heading_rad);
      out.rows.push_back({read.time_s, read.x_m + east * ahead_m - north * left_m,
                          read.y_m + north * ahead_m + east * left_m, read.heading_rad, read.slope_rad, slip,
                          load_N, 0.0, 0.0, w < 2 ? 1.0 : 2.0});
      speed.push_back(0.2 * (1.0 - (second == Second::Copied ? slip : read.second)));
      out.run.push_back("line" + std::to_string(read.line));
      out.wheel.push_back("w" + std::to_string(w));
    }
  terramech::Telemetry table = tableOf(out, false);
  if (second == Second::None) return table;
  table.numbers.push_back({"rim_speed_mps", std::vector<double>(speed.size(), 0.2)});
  table.numbers.push_back({"speed_mps", std::move(speed)});
  return table;
}

// Cells that are allowed in the uphill heading.
std::vector<bool> allowedOn(const TraversabilityMap& map) {
  std::vector<bool> cells;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const auto cell = map.published()->at({column, row});
      const double gradient = std::hypot(cell.dzDx(), cell.dzDy());
      cells.push_back(map.model().state(0, *map.ground({column, row}), gradient).refusal == Refusal::None);
    }
  return cells;
}

// Numbers of cells whose permission changed: allowed where the ground does not hold; allowed where it does; refused
// where perfect knowledge of the ground allows it. Numbers of cells that perfect knowledge allows and refuses.
struct Changed {
  int freed = 0, gained = 0, lost = 0, known_gained = 0, known_lost = 0;

  void add(const Changed& other) {
    for (int Changed::*const count :
         {&Changed::freed, &Changed::gained, &Changed::lost, &Changed::known_gained, &Changed::known_lost})
      this->*count += other.*count;
  }
};

Changed changesOf(const TraversabilityMap& map, const World& world, const std::vector<bool>& before) {
  const std::vector<bool> after = allowedOn(map);
  Changed out;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const maps::Cell at{static_cast<int>(i) % kSide, static_cast<int>(i) / kSide};
    const maps::Point centre = map.grid().centre(at);
    const auto cell = map.published()->at(at);
    const double gradient = std::hypot(cell.dzDx(), cell.dzDy());
    const GroundBelief truth{{world.strength() + world.departure(centre), 0.01},
                             map.model().prior(0).sinkage};
    const bool known = map.model().state(0, truth, gradient).refusal == Refusal::None,
               holds = world.holds(centre, gradient);
    out.freed += after[i] && !before[i] && !holds ? 1 : 0;
    out.gained += after[i] && !before[i] && holds ? 1 : 0;
    out.lost += !after[i] && before[i] && known ? 1 : 0;
    out.known_gained += known && !before[i] ? 1 : 0;
    out.known_lost += !known && before[i] ? 1 : 0;
  }
  return out;
}

// Errors of the strength of the class by drives, over its standard deviation.
struct Errors {
  int drives = 0, within_one = 0, within_two = 0;
  double bias = 0.0, square = 0.0;

  void add(const DriveReport& report, double truth) {
    if (report.learned.empty()) return;
    const Estimate& found = report.learned.front().pull;
    const double off = found.value - truth;
    ++drives;
    within_one += std::abs(off) < found.std ? 1 : 0;
    within_two += std::abs(off) < 2.0 * found.std ? 1 : 0;
    bias += off;
    square += off * off;
  }
};

// Property: one to three faulty drives of one kind, alone, after a sound drive, or after a sound drive on gentle
// ground, allow no ground that is too weak (tolerance: three cells in a thousand; more in one world of a hundred), and
// refuse little of what perfect knowledge of the ground allows (tolerance: 7000 cells in 128 worlds of 2304). Sound drives have the
// same property. The estimates of sound drives are unbiased and their deviations true, within the sampling error; those
// of faulty drives, too, where the slip is measured twice.
TEST(FaultWorlds, FaultsAllowNoWeakGround) {
  const CampaignPart part = campaignPart("TALUS_FAULT_WORLDS", 54);
  const auto class_model = groundOf(groundClass(1, sandPrior(), testRover()));
  const Pull of_class(*class_model);
  std::map<std::string, Changed> of_fault;
  std::map<std::string, Errors> of_drives;
  Changed all;
  unsigned worse = 0;
  std::size_t climbed = 0, refused = 0;
  for (unsigned seed = part.first; seed < part.end(); ++seed) {
    World world(seed);
    const std::string fault = kFaults[seed % std::size(kFaults)];
    const auto second = static_cast<Second>(seed / std::size(kFaults) % 4);
    const std::string slips = second == Second::Independent ? "two slips"
                              : second == Second::False     ? "second slip"
                                                            : "one slip";
    TraversabilityMap map(world.layers(), class_model, {});
    const int first = static_cast<int>(world.uniform(0.0, 3.0)),
              times = 1 + static_cast<int>(world.uniform(0.0, 3.0));
    std::map<std::size_t, double> cells;
    const auto drive = [&](const std::string& kind, int number, bool gentle) {
      const DriveReport report =
          addDrive(map, driven(world, of_class, map, kind, second, number, gentle, cells));
      of_drives[slips + (kind == "none" ? ", sound" : ", faulty")].add(report, world.strength());
    };
    if (first > 0) drive("none", 0, first == 2);
    const std::vector<bool> before = allowedOn(map);
    climbed += cells.size();
    for (const auto& [i, gradient] : cells) {
      const maps::Cell at{static_cast<int>(i) % kSide, static_cast<int>(i) / kSide};
      refused += map.model().state(0, *map.ground(at), gradient).refusal == Refusal::None ? 0U : 1U;
    }
    for (int i = 1; i <= times; ++i) drive(fault, i, false);
    const Changed changes = changesOf(map, world, before);
    of_fault[slips + ", " + fault].add(changes);
    all.add(changes);
    worse += changes.freed > 3 * kSide * kSide / 1000 ? 1U : 0U;
    if (changes.freed > 0)
      std::cout << "world " << seed << ": " << slips << ", " << fault << ", first " << first << ", " << times
                << " times, " << changes.freed << " cells\n";
  }
  of_fault["all"] = all;
  for (const auto& [fault, cells] : of_fault)
    std::cout << fault << ": allowed wrongly " << cells.freed << ", rightly " << cells.gained
              << ", refused needlessly " << cells.lost << "; by perfect knowledge allowed "
              << cells.known_gained << ", refused " << cells.known_lost << '\n';
  for (const auto& [kind, e] : of_drives) {
    const double drives = e.drives, bias = e.bias / drives, rms = std::sqrt(e.square / drives);
    std::cout << kind << ": " << drives << " drives, bias " << bias << ", rms " << rms
              << ", within one and two deviations " << e.within_one / drives << ", " << e.within_two / drives
              << '\n';
    if (kind == "one slip, faulty") continue;
    EXPECT_NEAR(bias, 0.0, 0.01 + 2.0 * rms / std::sqrt(drives)) << kind;
    EXPECT_GT(e.within_two, 0.9 * drives - 2.0 * std::sqrt(0.09 * drives)) << kind;
  }
  std::cout << "of " << climbed << " cells that sound rovers climbed, " << refused << " are refused uphill\n";
  EXPECT_LE(worse, std::max(part.count / 100, 1U));
  EXPECT_LE(all.lost, 7000 * static_cast<int>(part.count) / 128);
}

}  // namespace fault_worlds_test
}  // namespace talus::costmap
