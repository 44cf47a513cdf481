#include <algorithm>
#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/costmap/cost/level_climbs.hpp>
#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::costmap {

double interpolated(const std::vector<double>& values, double at) {
  const double x = std::clamp(at, 0.0, static_cast<double>(values.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(x), values.size() - 1);
  const auto next = std::min(k + 1, values.size() - 1);
  return values[k] + (x - static_cast<double>(k)) * (values[next] - values[k]);
}

LevelClimbs::LevelClimbs(const SlopeRow& level, double last)
    : last_(last), step_(level.step), first_node_(level.first_node) {
  double energy = 0.0, time = 0.0;
  for (const terramech::SlopeState& s : level.states) {
    energies_.push_back(energy = std::max(energy, s.energy_J_per_m));
    times_.push_back(time = std::max(time, 1.0 / s.speed_mps));
    slips_.push_back(s.slip);
  }
}

LevelClimbs::Surcharges LevelClimbs::surcharges(const SlopeRow& row) const {
  Surcharges all;
  for (std::size_t k = 0; k < row.states.size(); ++k) {
    const terramech::SlopeState& state = row.states[k];
    const double along = (row.first_node + static_cast<double>(k)) * row.step;
    const double needed =
        std::max(reached(energies_, state.energy_J_per_m), reached(times_, 1.0 / state.speed_mps));
    const double climb = std::max(along, std::min(needed, last_));
    all.climb.push_back(climb - along);
    all.slip.push_back(state.slip - interpolated(slips_, climb / step_ - first_node_));
  }
  return all;
}

double LevelClimbs::reached(const std::vector<double>& values, double value) const {
  const auto next = std::ranges::lower_bound(values, value);
  if (next == values.end()) return kInfinity;
  const auto k = next - values.begin();
  const double from = k == 0 ? value : values[static_cast<std::size_t>(k - 1)];
  const double back = *next > from ? (*next - value) / (*next - from) : 0.0;
  return (first_node_ + static_cast<double>(k) - back) * step_;
}

double strengthToLose(double along, double across, const LevelStrength& level,
                      const std::vector<double>& losses) {
  const auto fails = [&](double lost) {
    const double row = across / (1.0 - lost / level.thrust) * TravelCurve::kRowsPerUnit;
    return row > static_cast<double>(losses.size() - 1) ||
           along + lost + interpolated(losses, row) > level.last;
  };
  double low = -2.0, high = std::min(level.thrust * (1.0 - 1e-9), level.last - along);
  if (high <= low || !fails(high)) return std::max(high, low);
  for (int halving = 0; halving < 20; ++halving) {
    const double middle = 0.5 * (low + high);
    (fails(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace talus::costmap
