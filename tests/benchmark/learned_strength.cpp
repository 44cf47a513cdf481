// Strength that a map learns on ground weaker or stronger than its class, from drives with and without slip
// bias: rover mer, class mars_crusty, 96 x 96 m of steepening waves, four lines, uniform ground, no torque.
// One row for each truth.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace {

using namespace talus;
using namespace talus::costmap;

constexpr int kSide = 96;

MapLayers waves() {
  MapLayers layers;
  const maps::Grid grid{.width = kSide, .height = kSide, .resolution_m = 1.0, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      layers.elevation.elevation_m[{column, row}] = static_cast<float>(
          (0.3 + 0.9 * column / kSide) * std::sin(0.19 * column) + 0.4 * std::sin(0.11 * row));
  return layers;
}

std::shared_ptr<const GroundModel> modelOf(const terramech::Rover& rover, GroundClass ground,
                                           double strength) {
  ground.soil.cohesion_Pa *= strength;
  ground.soil.friction_angle_rad = std::atan(strength * std::tan(ground.soil.friction_angle_rad));
  return std::make_shared<GroundModel>(GroundModel::Parts{.rover = rover, .classes = {ground}, .policy = {}});
}

double pullAt(const GroundModel& model, double slip) {
  return (model.steady(0, {.slip = slip}).drawbar_pull_over_load +
          2.0 * model.steady(0, {.slip = slip, .in_rut = true}).drawbar_pull_over_load) /
         3.0;
}

double slipOn(const GroundModel& model, double gradient) {
  double low = -0.5, high = 0.95;
  while (high - low > 1e-4) (pullAt(model, 0.5 * (low + high)) < gradient ? low : high) = 0.5 * (low + high);
  return low;
}

using Read = std::function<double(double slip, double of_class)>;

// `twice`: true if the file states the speeds of the rover and of the rims as well.
terramech::Telemetry drive(const TraversabilityMap& map, const GroundModel& truth, const Read& read,
                           bool twice) {
  std::vector<const char*> names{"time_s",    "x_m",  "y_m",    "heading_rad",
                                 "slope_rad", "slip", "load_N", "pass_index"};
  if (twice) names.insert(names.end(), {"rim_speed_mps", "speed_mps"});
  terramech::Telemetry out;
  for (const char* name : names) out.numbers.push_back({name, {}});
  out.words = {{"run", {}}, {"wheel", {}}};
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  int line = 0;
  for (const double y_m : {16.5, 36.5, 56.5, 76.5}) {
    const double way = line++ % 2 == 0 ? 1.0 : -1.0;
    for (int i = 0; i < 250; ++i) {
      const double x_m = 48.0 + way * (0.35 * i - 43.5);
      const double gradient = way * map.published()->at(*map.grid().cellAt({x_m, y_m})).dzDx(),
                   slip = slipOn(truth, gradient);
      if (slip > 0.75) continue;
      const double seen = read(slip + 0.015 * noise(random), slipOn(map.model(), gradient));
      const double speed_mps = 0.2 * (1.0 - slip + 0.015 * noise(random));
      const double slope_rad = std::atan(gradient) + 0.005 * noise(random);
      for (int w = 0; w < 6; ++w) {
        const double row[] = {2.0 * i,
                              x_m + way * (0.4 - 0.4 * (w / 2)),
                              y_m + (w % 2 == 0 ? 0.3 : -0.3),
                              way > 0.0 ? 0.0 : std::numbers::pi,
                              slope_rad,
                              std::clamp(seen + 0.005 * noise(random), -1.0, 1.0),
                              terramech::wheelLoad_N(map.model().rover()),
                              w / 2 + 1.0,
                              0.2,
                              speed_mps};
        for (std::size_t c = 0; c < names.size(); ++c) out.numbers[c].values.push_back(row[c]);
        out.words[0].values.push_back("line" + std::to_string(line));
        out.words[1].values.push_back("w" + std::to_string(w));
        out.lines.push_back(out.lines.size() + 2);
      }
    }
  }
  return out;
}

// Numbers of cells allowed uphill that the true soil supports, and that it does not.
std::pair<int, int> allowed(const TraversabilityMap& map, const GroundModel& truth) {
  std::pair<int, int> cells{0, 0};
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const auto at = map.published()->at({column, row});
      const double gradient = std::hypot(at.dzDx(), at.dzDy());
      if (map.model().state(0, *map.ground({column, row}), gradient).refusal != Refusal::None) continue;
      ++(pullAt(truth, 0.8) >= gradient ? cells.first : cells.second);
    }
  return cells;
}

}  // namespace

int main() {
  const terramech::Rover rover = terramech::loadRover("mer");
  const GroundClass ground = groundClass(1, terramech::loadSoilPrior("mars_crusty"), rover);
  const std::pair<const char*, Read> sensors[] = {
      {"as it is", [](double slip, double) { return slip; }},
      {"- 0.1", [](double slip, double) { return slip - 0.1; }},
      {"x 0.8", [](double slip, double) { return 0.8 * slip; }},
      {"x 0.5", [](double slip, double) { return 0.5 * slip; }},
      {"x 0.3", [](double slip, double) { return 0.3 * slip; }},
      {"+ 0.1", [](double slip, double) { return slip + 0.1; }},
      {"of the class", [](double, double of_class) { return of_class; }}};
  std::printf(
      "| truth | slip | slips | offset, scale found | learned | if sound | counted on | held cells allowed | "
      "others allowed |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const bool twice : {false, true})
    for (const double strength : {0.81, 0.9, 1.0, 1.1, 1.22, 1.4}) {
      const auto truth = modelOf(rover, ground, strength);
      for (const auto& [name, read] : sensors) {
        TraversabilityMap map(waves(), modelOf(rover, ground, 1.0), {});
        const auto before = allowed(map, *truth);
        const DriveReport report = addDrive(map, drive(map, *truth, read, twice));
        const auto after = allowed(map, *truth);
        if (report.learned.empty()) continue;
        const LearnedClass& one = report.learned.front();
        std::printf(
            "| %.3f | %s | %s | %+.2f, %.2f | %.3f +- %.3f | %.3f +- %.3f | %.3f | %d -> %d | %d -> %d |\n",
            truth->reference(0, false).drawbar_pull_over_load, name, twice ? "two" : "one",
            report.slip_offset, report.slip_scale, one.pull.value, one.pull.std, one.if_sound.value,
            one.if_sound.std, one.counted_on, before.first, after.first, before.second, after.second);
      }
    }
}
