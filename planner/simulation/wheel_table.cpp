#include <algorithm>
#include <stdexcept>

#include <talus/planner/simulation/wheel_table.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::planner {
namespace {

// A wheel of the rover under some load.
struct Loaded {
  const terramech::Rover& rover;
  double load_N, slip;
};

WheelTable::Row between(const WheelTable::Row& a, const WheelTable::Row& b, double t) {
  return {a.pull + t * (b.pull - a.pull), a.torque + t * (b.torque - a.torque),
          a.sinkage + t * (b.sinkage - a.sinkage)};
}

WheelTable::Row solved(const terramech::Soil& soil, const Loaded& wheel) {
  const auto& [rover, load_N, slip] = wheel;
  try {
    const auto f = terramech::equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip});
    return {f.drawbar_pull_N / load_N, f.torque_Nm / (load_N * rover.wheel.radius_m),
            f.sinkage_m / rover.wheel.radius_m};
  } catch (const std::domain_error&) {
    return {-1.0, 1.0, 1.0};
  }
}

WheelTable::Row predicted(const terramech::RefinedModel& model, const Loaded& wheel) {
  const auto& [rover, load_N, slip] = wheel;
  terramech::WheelState state;
  state.wheel = rover.wheel;
  state.load_N = load_N;
  state.slip = slip;
  state.rim_speed_mps = rover.max_speed_mps * (slip < 0.0 ? 1.0 + slip : 1.0);
  state.speed_mps = rover.max_speed_mps * (1.0 - std::max(slip, 0.0));
  state.slope_rad = 0.0;
  state.gravity_m_s2 = rover.gravity_m_s2;
  state.pass_index = 1.0;
  const terramech::Reading r = terramech::predict(model, state);
  if (r.sinkage_m >= rover.wheel.radius_m) return {-1.0, 1.0, 1.0};
  return {r.drawbar_pull_N / state.load_N, r.torque_Nm / (state.load_N * rover.wheel.radius_m),
          r.sinkage_m / rover.wheel.radius_m};
}

}  // namespace

WheelTable::WheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
                       const std::vector<terramech::Effect>& effects) {
  terramech::RefinedModel model;
  model.soil = soil;
  model.effects = effects;
  for (std::size_t layer = 0; layer < kLoads; ++layer)
    for (std::size_t i = 0; i < kRows; ++i) {
      const Loaded wheel{rover, load(layer) * terramech::wheelLoad_N(rover), slip(i)};
      rows_[layer][i] = effects.empty() ? solved(soil, wheel) : predicted(model, wheel);
    }
}

WheelTable::Row WheelTable::row(std::size_t i, double load_over_flat) const noexcept {
  const double position = std::clamp((load_over_flat - load(0)) / (load(1) - load(0)), 0.0, kLoads - 1.0);
  const auto k = std::min(static_cast<std::size_t>(position), kLoads - 2);
  return between(rows_[k][i], rows_[k + 1][i], position - static_cast<double>(k));
}

WheelTable::Row WheelTable::at(double slip, double load_over_flat) const noexcept {
  const double position = (std::clamp(slip, -1.0, 1.0) + 1.0) * 0.5 * (kRows - 1);
  const auto i = std::min(static_cast<std::size_t>(position), kRows - 2);
  return between(row(i, load_over_flat), row(i + 1, load_over_flat), position - static_cast<double>(i));
}

}  // namespace talus::planner
