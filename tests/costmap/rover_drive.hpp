#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

constexpr int kRoverSide = 72;

inline std::shared_ptr<const GroundModel> groundOf(const terramech::Soil& first, int wheels) {
  terramech::Rover rover = testRover();
  rover.wheel_count = wheels;
  rover.mass_kg *= wheels / 4.0;
  return std::make_shared<GroundModel>(GroundModel::Parts{
      .rover = rover,
      .classes = {GroundClass{.number = 1, .soil = first}, GroundClass{.number = 2, .soil = testSand()}},
      .policy = {}});
}

/// Sand with the deviations of its class, and a soil drawn from them, each parameter within two deviations.
inline terramech::SoilPrior sandPrior() {
  return {.mean = testSand(),
          .deviation = {.cohesion_Pa = 300.0,
                        .friction_angle_rad = 0.07,
                        .sinkage_exponent = 0.15,
                        .frictional_modulus = 150000.0,
                        .shear_modulus_m = 0.25 * testSand().shear_modulus_m,
                        .rut_stiffness = 1.0}};
}
inline terramech::Soil drawnSand(std::mt19937_64& random) {
  terramech::Soil soil = testSand();
  const terramech::SoilDeviation std = sandPrior().deviation;
  std::normal_distribution<double> normal;
  const auto draw = [&](double& value, double deviation) {
    value = std::max(value + deviation * std::clamp(normal(random), -2.0, 2.0), 0.3 * value);
  };
  draw(soil.cohesion_Pa, std.cohesion_Pa);
  draw(soil.friction_angle_rad, std.friction_angle_rad);
  draw(soil.sinkage_exponent, std.sinkage_exponent);
  draw(soil.frictional_modulus, std.frictional_modulus);
  draw(soil.shear_modulus_m, std.shear_modulus_m);
  draw(soil.rut_stiffness, std.rut_stiffness);
  return soil;
}

/// Ground of one class of a rover with four wheels.
inline std::shared_ptr<const GroundModel> groundOf(const GroundClass& ground) {
  return std::make_shared<GroundModel>(
      GroundModel::Parts{.rover = testRover(), .classes = {ground}, .policy = {}});
}

/// Waves of the given height: 1.5 m yields slopes up to 17 degrees, some too steep for weak sand.
inline MapLayers hills(double height_m = 1.5) {
  MapLayers layers;
  const maps::Grid grid{.width = kRoverSide, .height = kRoverSide, .resolution_m = 1.0, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  for (int row = 0; row < kRoverSide; ++row)
    for (int column = 0; column < kRoverSide; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(height_m * std::sin(0.19 * column) + 0.8 * std::sin(0.11 * row));
  return layers;
}

/// A map of the hills with the given soil as its only class.
inline TraversabilityMap mapOf(const terramech::Soil& soil, int wheels, double height_m = 1.5) {
  return TraversabilityMap(hills(height_m), groundOf(soil, wheels), {});
}

/// Rows: time_s x_m y_m heading_rad slope_rad slip load_N torque_Nm sinkage_m pass.
struct Drive {
  std::vector<std::vector<double>> rows;
  std::vector<std::string> run, wheel;
};
enum Column { kTime, kX, kY, kHeading, kSlope, kSlip, kLoad, kTorque, kSinkage, kPass };

/// Converts a drive to telemetry. `felt`: true if torque and sinkage are columns of the file.
inline terramech::Telemetry tableOf(const Drive& drive, bool felt = true) {
  terramech::Telemetry out;
  out.source = "rover.csv";
  const char* const names[] = {"time_s", "x_m",    "y_m",       "heading_rad", "slope_rad",
                               "slip",   "load_N", "torque_Nm", "sinkage_m",   "pass_index"};
  for (std::size_t c = 0; c < std::size(names); ++c) {
    if (!felt && (c == kTorque || c == kSinkage)) continue;
    out.numbers.push_back({names[c], {}});
    for (const auto& row : drive.rows) out.numbers.back().values.push_back(row[c]);
  }
  out.words = {{"run", drive.run}, {"wheel", drive.wheel}};
  for (std::size_t i = 0; i < drive.rows.size(); ++i) out.lines.push_back(i + 2);
  return out;
}

/// Adds speeds of rover and rims that give the slip a second time, with a noise of 0.02.
inline terramech::Telemetry measuredTwice(terramech::Telemetry drive) {
  std::vector<double> speed, rim;
  for (const double slip : drive.at("slip")) {
    rim.push_back(0.2);
    speed.push_back(0.2 * (1.0 - slip + (rim.size() % 2 == 0 ? 0.02 : -0.02)));
  }
  drive.numbers.push_back({"speed_mps", speed});
  drive.numbers.push_back({"rim_speed_mps", rim});
  return drive;
}

/// A drive back and forth along lines of the map, on one soil. All wheels have the same slip; their mean
/// pull equals the demand of the slope as far as the soil allows.
inline Drive driveOver(const TraversabilityMap& map, const terramech::Soil& soil, unsigned seed,
                       const std::vector<double>& lines_m = {8.5, 33.5, 58.5}) {
  const terramech::Rover& rover = map.model().rover();
  const auto truth = groundOf(soil, rover.wheel_count);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  const int axles = rover.wheel_count / 2;
  const auto pullAt = [&](double slip) {
    return (truth->steady(0, {slip, false}).drawbar_pull_over_load +
            (axles - 1) * truth->steady(0, {slip, true}).drawbar_pull_over_load) /
           axles;
  };
  Drive out;
  int line = 0;
  for (const double y_m : lines_m) {
    const double way = line++ % 2 == 0 ? 1.0 : -1.0;
    for (int i = 0; i < 180; ++i) {
      const double x_m = 36.0 + way * (0.35 * i - 31.0);
      const double gradient = way * map.published()->at(*map.grid().cellAt({x_m, y_m})).dzDx();
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

/// Sand that is too weak for the steeper slopes; weakerSand() has a lower strength than weakSand().
inline terramech::Soil weakSand() {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = 300.0;
  soil.friction_angle_rad = 0.52;
  soil.frictional_modulus = 500000.0;
  return soil;
}

inline terramech::Soil weakerSand() {
  terramech::Soil soil = weakSand();
  soil.friction_angle_rad = 0.45;
  return soil;
}

}  // namespace talus::costmap
