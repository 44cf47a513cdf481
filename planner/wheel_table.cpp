#include <algorithm>
#include <stdexcept>

#include <planner/wheel_table.hpp>
#include <terramech/refined_model.hpp>
#include <terramech/wong_reece.hpp>

namespace talus::planner {
namespace {

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

WheelTable::Row predicted(const terramech::RefinedModel& model, const terramech::Rover& rover, double slip) {
  terramech::WheelState state;
  state.wheel = rover.wheel;
  state.load_N = terramech::wheelLoad_N(rover);
  state.slip = slip;
  state.rim_speed_mps = rover.max_speed_mps * (slip < 0.0 ? 1.0 + slip : 1.0);
  state.speed_mps = rover.max_speed_mps * (1.0 - std::max(slip, 0.0));
  state.slope_rad = 0.0;
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
  for (std::size_t i = 0; i < kRows; ++i)
    rows_[i] = effects.empty() ? solved(soil, rover, slip(i)) : predicted(model, rover, slip(i));
}

WheelTable::Row WheelTable::at(double slip) const noexcept {
  const double position = (std::clamp(slip, -1.0, 1.0) + 1.0) * 0.5 * (kRows - 1);
  const auto i = std::min(static_cast<std::size_t>(position), kRows - 2);
  const double t = position - static_cast<double>(i);
  const Row &a = rows_[i], &b = rows_[i + 1];
  return {a.pull + t * (b.pull - a.pull), a.torque + t * (b.torque - a.torque),
          a.sinkage + t * (b.sinkage - a.sinkage)};
}

}  // namespace talus::planner
