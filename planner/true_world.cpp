#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <planner/true_world.hpp>
#include <terramech/wong_reece.hpp>

namespace talus::planner {
namespace {

constexpr int kRows = 81;  // of slip -1 .. 1
constexpr double kHighestSlip = 0.98;
constexpr double kSlipStep = 0.02;

WheelTable::Row solved(const terramech::Soil& soil, const terramech::Rover& rover, double slip) {
  const double load_N = terramech::wheelLoad_N(rover);
  try {
    const auto f = terramech::equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip});
    return {f.drawbar_pull_N / load_N, f.torque_Nm / (load_N * rover.wheel.radius_m),
            f.sinkage_m / rover.wheel.radius_m};
  } catch (const std::domain_error&) {
    return {-1.0, 1.0, 1.0};
  }
}

}  // namespace

WheelTable::WheelTable(const terramech::Soil& soil, const terramech::Rover& rover) {
  for (int i = 0; i < kRows; ++i) rows_.push_back(solved(soil, rover, 2.0 * i / (kRows - 1) - 1.0));
}

WheelTable::Row WheelTable::at(double slip) const noexcept {
  const double position = (std::clamp(slip, -1.0, 1.0) + 1.0) * 0.5 * (kRows - 1);
  const auto i = std::min(static_cast<std::size_t>(position), static_cast<std::size_t>(kRows - 2));
  const double t = position - static_cast<double>(i);
  const Row &a = rows_[i], &b = rows_[i + 1];
  return {a.pull + t * (b.pull - a.pull), a.torque + t * (b.torque - a.torque),
          a.sinkage + t * (b.sinkage - a.sinkage)};
}

TrueWorld::TrueWorld(const WorldSoils& soils, const terramech::Rover& rover,
                     const maps::Raster<std::uint8_t>& class_index)
    : soils_(soils), rover_(rover), class_index_(class_index) {
  for (const auto& soil : soils_.classes) tables_.emplace_back(soil, rover);
  for (const auto& patch : soils_.patches) tables_.emplace_back(patch.soil, rover);
}

std::size_t TrueWorld::soilAt(const maps::Point& place) const noexcept {
  for (std::size_t i = soils_.patches.size(); i-- > 0;) {
    const SoilPatch& patch = soils_.patches[i];
    if (std::hypot(place.x_m - patch.centre.x_m, place.y_m - patch.centre.y_m) < patch.radius_m)
      return soils_.classes.size() + i;
  }
  const auto cell = class_index_.grid().cellAt(place);
  return cell ? std::min<std::size_t>(class_index_[*cell], soils_.classes.size() - 1) : 0;
}

double TrueWorld::meanPull(const std::vector<std::size_t>& soils, double slip) const noexcept {
  double sum = 0.0;
  for (const std::size_t soil : soils) sum += tables_[soil].at(slip).pull;
  return sum / static_cast<double>(soils.size());
}

TrueWorld::Step TrueWorld::drive(const maps::Point& place, const costmap::Direction& heading,
                                 double gradient) const {
  constexpr std::array<std::pair<double, double>, 4> kCorners{{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
  Step step;
  std::vector<std::size_t> soils;
  for (const auto& [along, across] : kCorners) {
    const double a = 0.5 * along * rover_.wheelbase_m, b = 0.5 * across * rover_.track_m;
    step.wheels.push_back(
        {place.x_m + a * heading.x - b * heading.y, place.y_m + a * heading.y + b * heading.x});
    soils.push_back(soilAt(step.wheels.back()));
  }
  // The least slip that pulls enough: on soft ground the pull falls again as the wheel digs in.
  double high = -1.0;
  while (high < kHighestSlip && meanPull(soils, high) < gradient) high += kSlipStep;
  step.stuck = high >= kHighestSlip;
  double low = high - kSlipStep;
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = 0.5 * (low + high);
    (meanPull(soils, middle) < gradient ? low : high) = middle;
  }
  step.slip = step.stuck ? kHighestSlip : high;
  double torque = 0.0;
  for (const std::size_t soil : soils) {
    step.rows.push_back(tables_[soil].at(step.slip));
    torque += step.rows.back().torque / static_cast<double>(soils.size());
  }
  // Power of all wheels over the speed: N T omega / v with omega = v/(r (1 - i)); a braking wheel gives
  // nothing back.
  const double weight_N = rover_.mass_kg * rover_.gravity_m_s2 / std::hypot(1.0, gradient);
  step.speed_mps = rover_.max_speed_mps * (1.0 - std::max(step.slip, 0.0));
  step.energy_J_per_m = std::max(torque, 0.0) * weight_N / (1.0 - std::max(step.slip, 0.0)) +
                        rover_.hotel_power_W / step.speed_mps;
  return step;
}

}  // namespace talus::planner
