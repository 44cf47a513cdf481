// Worlds of known soil in which faulty drives follow sound drives; counts the cells that become allowed wrongly
// and rightly, and refused needlessly. TALUS_FAULT_WORLDS="FIRST COUNT" replaces the worlds of each run; a
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
    terramech::Soil soil = testSand();
    const double strength = uniform(0.8, 1.2);
    soil.cohesion_Pa *= strength;
    soil.friction_angle_rad = std::atan(strength * std::tan(soil.friction_angle_rad));
    soil.shear_modulus_m *= std::exp(uniform(-0.4, 0.4));
    truth_.emplace(*groundOf(soil, kWheels));
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
  double strength() const { return truth_->at(0.5, 0.0); }
  double slip(double gradient, const maps::Point& at) const {
    return truth_->slipOn(gradient, departure(at));
  }
  bool holds(const maps::Point& at, double gradient) const {
    return truth_->at(0.8, departure(at)) >= gradient;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double height_m_ = 0.0, variation_ = 0.0;
  std::optional<Pull> truth_;
  std::vector<double> phases_;
};

// Reading common to all wheels of a moment.
struct Read {
  double time_s, x_m, y_m, slope_rad, slip;
};

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

// A drive along three lines over the waves; a gentle drive follows crests and troughs, on slopes up to 0.05.
terramech::Telemetry driven(World& world, const Pull& of_class, const TraversabilityMap& map,
                            const std::string& fault, int number, bool gentle = false) {
  Drive out;
  const double load_N = terramech::wheelLoad_N(map.model().rover());
  const double one_wheel = fault == "one_wheel" ? world.uniform(-0.3, 0.3) : 0.0;
  for (int line = 0; line < 3; ++line) {
    const double way = line % 2 == 0 ? 1.0 : -1.0;
    const double beside_m = gentle ? 6.8 + 12.57 * line : 8.5 + 14.0 * line + world.uniform(-2.0, 2.0);
    const double heading_rad = (gentle ? 0.5 : 0.0) * std::numbers::pi + (way > 0.0 ? 0.0 : std::numbers::pi);
    const double east = std::cos(heading_rad), north = std::sin(heading_rad);
    std::vector<Read> drive;
    for (int i = 0; i < 90; ++i) {
      const double along_m = 24.0 + way * (0.47 * i - 20.7);
      const maps::Point at = gentle ? maps::Point{beside_m, along_m} : maps::Point{along_m, beside_m};
      const auto cell = map.published()->at(*map.grid().cellAt(at));
      const double gradient = east * cell.dzDx() + north * cell.dzDy();
      const double slip = world.slip(gradient, at);
      drive.push_back({1e5 * number + 1e4 * line + 2.0 * i, at.x_m, at.y_m,
                       std::atan(gradient) + 0.005 * world.noise(), slip + 0.015 * world.noise()});
    }
    spoil(fault, drive, world, of_class);
    for (std::size_t i = 0; i < drive.size(); ++i)
      for (int w = 0; w < kWheels; ++w) {
        const double slip = drive[i].slip + 0.005 * world.noise() + (w == 1 ? one_wheel : 0.0);
        const double ahead_m = w < 2 ? 0.4 : -0.4, left_m = w % 2 == 0 ? 0.3 : -0.3;
        out.rows.push_back({drive[i].time_s, drive[i].x_m + east * ahead_m - north * left_m,
                            drive[i].y_m + north * ahead_m + east * left_m, heading_rad, drive[i].slope_rad,
                            std::clamp(slip, -1.0, 1.0), load_N, 0.0, 0.0, w < 2 ? 1.0 : 2.0});
        out.run.push_back("line" + std::to_string(line));
        out.wheel.push_back("w" + std::to_string(w));
      }
  }
  return tableOf(out, false);
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

// Numbers of cells whose permission changed.
struct Changed {
  int freed = 0, gained = 0, lost = 0;  // allowed wrongly, allowed rightly, refused needlessly

  void add(const Changed& other) {
    freed += other.freed;
    gained += other.gained;
    lost += other.lost;
  }
};

// Changes by the drives of a map, and by perfect knowledge of the ground.
struct Changes {
  Changed drives, knowledge;
};
Changes changesOf(const TraversabilityMap& map, const World& world, const std::vector<bool>& before,
                  double strength) {
  const std::vector<bool> after = allowedOn(map);
  const GroundBelief prior = map.model().prior(0);
  Changes out;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const maps::Cell at{static_cast<int>(i) % kSide, static_cast<int>(i) / kSide};
    const maps::Point centre = map.grid().centre(at);
    const auto cell = map.published()->at(at);
    const double gradient = std::hypot(cell.dzDx(), cell.dzDy());
    const GroundBelief truth{{prior.pull.value + strength + world.departure(centre), 0.01}, prior.sinkage};
    const bool known = map.model().state(0, truth, gradient).refusal == Refusal::None;
    const bool holds = world.holds(centre, gradient);
    const auto count = [&](bool now, Changed& changed) {
      changed.freed += now && !before[i] && !holds ? 1 : 0;
      changed.gained += now && !before[i] && holds ? 1 : 0;
      changed.lost += !now && before[i] && holds ? 1 : 0;
    };
    count(after[i], out.drives);
    count(known, out.knowledge);
  }
  return out;
}

// Property: one to three faulty drives of one kind, alone, after a sound drive, or after a sound drive on
// gentle ground, make no cell allowed whose ground is too weak; and they refuse no more ground needlessly than
// perfect knowledge, by the categories of the thesis. Tolerance: three in a thousand cells; more in one world of
// a hundred. Sound drives have the same property.
TEST(FaultWorlds, FaultsAllowNoWeakGround) {
  const CampaignPart part = campaignPart("TALUS_FAULT_WORLDS", 54);
  const auto class_model = groundOf(testSand(), kWheels);
  const Pull of_class(*class_model);
  std::map<std::string, Changed> of_fault;
  Changed drives, knowledge;
  unsigned worse = 0;
  for (unsigned seed = part.first; seed < part.end(); ++seed) {
    World world(seed);
    const std::string fault = kFaults[seed % std::size(kFaults)];
    TraversabilityMap map(world.layers(), class_model, {});
    const std::size_t first = seed / std::size(kFaults) % 3;
    if (first > 0) addDrive(map, driven(world, of_class, map, "none", 0, first == 2));
    const std::vector<bool> before = allowedOn(map);
    const int times = 1 + static_cast<int>(seed % 3);
    for (int i = 1; i <= times; ++i) addDrive(map, driven(world, of_class, map, fault, i));
    const Changes changes = changesOf(map, world, before, world.strength() - of_class.at(0.5, 0.0));
    of_fault[fault].add(changes.drives);
    drives.add(changes.drives);
    knowledge.add(changes.knowledge);
    worse += changes.drives.freed > 3 * kSide * kSide / 1000 ? 1U : 0U;
    if (changes.drives.freed > 0)
      std::cout << "world " << seed << ": " << fault << ", first " << first << ", " << times << " times, "
                << changes.drives.freed << " cells\n";
  }
  of_fault["all"] = drives;
  of_fault["perfect knowledge"] = knowledge;
  for (const auto& [fault, cells] : of_fault)
    std::cout << fault << ": allowed wrongly " << cells.freed << ", rightly " << cells.gained
              << ", refused needlessly " << cells.lost << '\n';
  EXPECT_LE(worse, std::max(part.count / 100, 1U));
  EXPECT_LE(drives.lost, knowledge.lost);
}

}  // namespace fault_worlds_test
}  // namespace talus::costmap
