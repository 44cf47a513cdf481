#include <algorithm>
#include <array>
#include <cmath>

#include <talus/terramech/mobility/slope_table.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

constexpr std::array kNumbers{&SlopeState::stability_margin_rad,
                              &SlopeState::slip,
                              &SlopeState::slip_angle_rad,
                              &SlopeState::steering_rad,
                              &SlopeState::slip_difference,
                              &SlopeState::body_turn_rad,
                              &SlopeState::sinkage_m,
                              &SlopeState::torque_Nm,
                              &SlopeState::side_force_over_load,
                              &SlopeState::energy_J_per_m,
                              &SlopeState::speed_mps,
                              &SlopeState::pull_reserve,
                              &SlopeState::side_reserve};

/// Returns the state on the mirrored plane: lateral quantities change sign.
SlopeState mirror(SlopeState state) {
  for (auto field : {&SlopeState::slip_angle_rad, &SlopeState::steering_rad, &SlopeState::slip_difference,
                     &SlopeState::body_turn_rad})
    state.*field = -(state.*field);
  return state;
}

const SlopeTableOptions& checked(const SlopeTableOptions& options) {
  const RangeCheck check{"slope table options"};
  check.within("step", options.step, {1e-3, 0.5});
  check.within("max_gradient", options.max_gradient, {options.step, 2.0});
  return options;
}

}  // namespace

SlopeTable::SlopeTable(const SlopeEquilibrium& equilibrium, const SlopeTableOptions& options)
    : options_(checked(options)),
      mirrored_(equilibrium.symmetric()),
      reach_(static_cast<int>(std::ceil(options.max_gradient / options.step - 1e-9))),
      columns_(mirrored_ ? reach_ + 1 : 2 * reach_ + 1) {
  states_.reserve(static_cast<std::size_t>((2 * reach_ + 1) * columns_));
  for (int a = -reach_; a <= reach_; ++a)
    for (int c = mirrored_ ? 0 : -reach_; c <= reach_; ++c)
      states_.push_back(equilibrium.at({a * options_.step, c * options_.step}));
}

SlopeState SlopeTable::at(const Gradient& gradient) const noexcept {
  if (!mirrored_ || gradient.across >= 0.0) return between(gradient.along, gradient.across);
  return mirror(between(gradient.along, -gradient.across));
}

SlopeState SlopeTable::between(double along, double across) const noexcept {
  const double x = along / options_.step, y = across / options_.step;
  const auto cell = [&](double position, int lowest) {
    return std::clamp(static_cast<int>(std::floor(position)), lowest, reach_ - 1);
  };
  const bool beyond = !(std::abs(x) <= reach_ && std::abs(y) <= reach_);
  const int i = beyond ? 0 : cell(x, -reach_), j = beyond ? 0 : cell(y, mirrored_ ? 0 : -reach_);
  const double s = beyond ? 0.0 : x - i, t = beyond ? 0.0 : y - j;
  SlopeState state;
  if (beyond) {
    state.failure = along > 0.0 ? SlopeFailure::CannotPull : SlopeFailure::Slides;
    return state;
  }
  const std::array<const SlopeState*, 4> corners{&node(i, j), &node(i + 1, j), &node(i, j + 1),
                                                 &node(i + 1, j + 1)};
  const std::array<double, 4> weights{(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t};
  for (std::size_t k = 0; k < 4; ++k) {
    if (weights[k] > 0.0 && !corners[k]->holds() && state.holds()) state.failure = corners[k]->failure;
    for (const auto field : kNumbers) state.*field += weights[k] * (corners[k]->*field);
  }
  return state;
}

}  // namespace talus::terramech
