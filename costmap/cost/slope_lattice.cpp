#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::costmap {

namespace {

using terramech::Gradient;
using terramech::SlopeEquilibrium;
using terramech::SlopeFailure;
using terramech::SlopeState;

constexpr int kAlongPerUnit = 32, kAcrossPerUnit = 32;  // solved gradients; divide those of TravelCurve

constexpr double kNever = 1e6;  // energy [J/m] and time [s/m] where no strength holds

// The rover with later axles in ruts, and with all wheels on fresh ground.
struct Standings {
  SlopeEquilibrium in_ruts, fresh;
};

StrengthColumn solvedOnSide(const Standings& rover, const Gradient& gradient, double near) {
  StrengthColumn column;
  const double least = rover.in_ruts.leastStrength(gradient, near);
  column.least = static_cast<float>(least);
  // Wheels in ruts pull more uphill and brake less downhill.
  column.required = static_cast<float>(std::max(least, rover.fresh.leastStrength(gradient, least)));
  const double strength = std::max(1.0, static_cast<double>(column.required));
  const SlopeState ruts = rover.in_ruts.at(gradient, strength), fresh = rover.fresh.at(gradient, strength);
  if (ruts.energy_J_per_m > 0.0 && fresh.speed_mps > 0.0) {
    column.fresh_energy = static_cast<float>(fresh.energy_J_per_m / ruts.energy_J_per_m);
    column.fresh_time = static_cast<float>(ruts.speed_mps / fresh.speed_mps);
  }
  // The body turns as on ground of the class or, where that fails, as on the weakest ground that holds.
  column.margin_rad =
      static_cast<float>(rover.in_ruts.at(gradient, std::max(1.0, least)).stability_margin_rad);
  SlopeState s{.energy_J_per_m = kNever, .speed_mps = 1.0 / kNever};
  for (std::size_t k = 0; k < StrengthColumn::kExcess.size(); ++k) {
    // Where Newton's method fails, the state of the weaker ground stays.
    const SlopeState next = rover.in_ruts.at(gradient, least + StrengthColumn::kExcess[k]);
    if (next.speed_mps > 0.0) s = next;
    const std::array<double, StrengthColumn::kQuantities> values{
        s.energy_J_per_m, 1.0 / s.speed_mps,     s.slip, s.sinkage_m, s.torque_Nm,
        s.slip_angle_rad, s.side_force_over_load};
    for (std::size_t q = 0; q < values.size(); ++q) column.entries[q][k] = static_cast<float>(values[q]);
  }
  return column;
}

// Of two sides, the one that needs more strength or, with equal strength, more energy.
StrengthColumn solved(const Standings& rover, const Gradient& gradient, double near) {
  StrengthColumn column = solvedOnSide(rover, gradient, near);
  if (rover.fresh.symmetric() || gradient.across == 0.0) return column;
  StrengthColumn other = solvedOnSide(rover, {gradient.along, -gradient.across}, near);
  for (float& angle : other.entries[StrengthColumn::kSlipAngle]) angle = -angle;
  const float margin_rad = std::min(column.margin_rad, other.margin_rad);
  const auto effort = [](const StrengthColumn& c) { return c.entries[StrengthColumn::kEnergy].front(); };
  if (std::abs(other.least - column.least) < 1e-3F ? effort(other) > effort(column)
                                                   : other.least > column.least)
    column = other;
  column.margin_rad = margin_rad;
  return column;
}

StrengthColumn mixed(const StrengthColumn& a, const StrengthColumn& b, float share) noexcept {
  if (share == 0.0F) return a;
  StrengthColumn out = a;
  out.least += share * (b.least - a.least);
  out.required += share * (b.required - a.required);
  out.margin_rad += share * (b.margin_rad - a.margin_rad);
  out.fresh_energy += share * (b.fresh_energy - a.fresh_energy);
  out.fresh_time += share * (b.fresh_time - a.fresh_time);
  for (std::size_t q = 0; q < out.entries.size(); ++q)
    for (std::size_t k = 0; k < out.entries[q].size(); ++k)
      out.entries[q][k] += share * (b.entries[q][k] - a.entries[q][k]);
  return out;
}

}  // namespace

StrengthColumn::Place StrengthColumn::place(double excess) noexcept {
  const double at = std::sqrt(std::clamp(excess, 0.0, kSpan) / kSpan) * (kStrengths - 1);
  const auto k = static_cast<std::size_t>(std::min(static_cast<int>(at), kStrengths - 2));
  return {k, std::clamp((excess - kExcess[k]) / (kExcess[k + 1] - kExcess[k]), 0.0, 1.0)};
}

SlopeLattice::SlopeLattice(const SlopeEquilibrium& equilibrium, const TravelCost::Limits& limits,
                           bool across) {
  const int half = std::min(static_cast<int>(limits.max_along * TravelCurve::kBinsPerUnit) + 2,
                            TravelCurve::kBins / 2 - 1);
  first_ = TravelCurve::kBins / 2 - half;
  last_ = TravelCurve::kBins / 2 + half;
  // Interpolation at the roll limit needs the row beyond. Gradients across are at most 1.
  const int rows =
      across ? static_cast<int>(std::min(limits.max_across, 1.0) * TravelCurve::kRowsPerUnit) + 2 : 1;
  constexpr int kBinsPerStep = TravelCurve::kBinsPerUnit / kAlongPerUnit,
                kRowsPerStep = TravelCurve::kRowsPerUnit / kAcrossPerUnit;
  const int steps = (half + kBinsPerStep - 1) / kBinsPerStep,
            solved_rows = (rows - 1 + kRowsPerStep - 1) / kRowsPerStep;
  const Standings rover{equilibrium, equilibrium.withoutRuts()};
  std::vector<std::vector<StrengthColumn>> lattice;
  for (int row = 0; row <= solved_rows; ++row) {
    std::vector<StrengthColumn>& here = lattice.emplace_back();
    for (int k = -steps; k <= steps; ++k) {
      const float near = !here.empty() ? here.back().least
                         : row > 0     ? lattice[static_cast<std::size_t>(row - 1)].front().least
                                       : 0.5F;
      here.push_back(
          solved(rover, {static_cast<double>(k) / kAlongPerUnit, static_cast<double>(row) / kAcrossPerUnit},
                 static_cast<double>(near)));
    }
  }
  for (int row = 0; row < rows; ++row) {
    const auto low = static_cast<std::size_t>(row / kRowsPerStep),
               high = std::min(low + 1, lattice.size() - 1);
    const float up = static_cast<float>(row % kRowsPerStep) / kRowsPerStep;
    for (int bin = -half; bin <= half; ++bin) {
      const int place = bin + steps * kBinsPerStep;
      const auto left = static_cast<std::size_t>(place / kBinsPerStep),
                 right = std::min(left + 1, lattice[low].size() - 1);
      const float on = static_cast<float>(place % kBinsPerStep) / kBinsPerStep;
      nodes_.push_back(mixed(mixed(lattice[low][left], lattice[low][right], on),
                             mixed(lattice[high][left], lattice[high][right], on), up));
    }
  }
  findClimbs();
  findSteepest();
}

// Climbs require more strength the steeper they are, from the gradient that requires least.
void SlopeLattice::findClimbs() {
  const auto row0 = [&](int i) { return nodes_[static_cast<std::size_t>(i)].required; };
  int from = 0;
  for (int i = 1; i < bins(); ++i)
    if (row0(i) < row0(from)) from = i;
  const auto climbOf = [&](float strength) {
    int i = from;
    while (i + 1 < bins() && row0(i + 1) < strength) ++i;
    if (i + 1 >= bins()) return TravelCurve::gradient(last_) + static_cast<double>(strength - row0(i));
    const float step = row0(i + 1) - row0(i);
    const float share = step > 0.0F ? std::clamp((strength - row0(i)) / step, 0.0F, 1.0F) : 0.0F;
    return TravelCurve::gradient(first_ + i + static_cast<double>(share));
  };
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int i = static_cast<int>(n) % bins();
    const double own = TravelCurve::gradient(first_ + i);
    climbs_.push_back(
        static_cast<float>(own + std::max(0.0, climbOf(nodes_[n].required) - climbOf(row0(i)))));
    if (n >= static_cast<std::size_t>(bins()))
      climbs_.back() = std::max(climbs_.back(), climbs_[n - static_cast<std::size_t>(bins())]);
  }
}

double SlopeLattice::climb(const Gradient& gradient) const noexcept {
  constexpr double kNowhere = 4.0;  // steeper than any cell
  const double place = gradient.along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2;
  if (!(place >= first_ && place < last_)) return kNowhere;
  double most = gradient.along;
  TravelCurve::forNodesAround(gradient, [&](int row, int bin, double) {
    most = std::max(most, node(row, bin).margin_rad < 0.0F ? kNowhere : climbOf(row, bin));
  });
  return std::min(most, kNowhere);
}

void SlopeLattice::findSteepest() {
  constexpr int kHeadings = 24;  // over 180 degrees: left and right are symmetric
  for (int step = 0; step <= 1024; ++step) {
    const double gradient = step * CellCode::kStep;
    double most = gradient;
    for (int k = 0; k < kHeadings; ++k) {
      const double heading = k * std::numbers::pi / kHeadings;
      most = std::max(most, climb({gradient * std::cos(heading), gradient * std::sin(heading)}));
    }
    steepest_.push_back(static_cast<float>(most));
  }
}

double SlopeLattice::steepest(double gradient) const noexcept {
  const double step = gradient / CellCode::kStep;
  if (!(step <= 1024.0)) return gradient;
  return std::max(gradient, static_cast<double>(steepest_[static_cast<std::size_t>(std::ceil(step))]));
}

TabulatedStates::TabulatedStates(std::vector<TravelState> states) : states_(std::move(states)) {
  if (states_.empty() || states_.size() % TravelCurve::kBins != 0)
    throw std::invalid_argument("travel states: " + std::to_string(states_.size()) +
                                " states, must be a multiple of " + std::to_string(TravelCurve::kBins));
}

TravelState TabulatedStates::at(int row, int bin) const {
  const int last = static_cast<int>(states_.size()) / TravelCurve::kBins - 1;
  return states_[static_cast<std::size_t>(std::min(row, last) * TravelCurve::kBins + bin)];
}

std::vector<TravelStates::Terms> TabulatedStates::terms() const {
  std::vector<Terms> terms;
  for (const TravelState& s : states_)
    terms.push_back({s.refusal == Refusal::None ? s.energy_J_per_m : std::numeric_limits<float>::infinity(),
                     s.time_s_per_m, s.risk_per_m});
  return terms;
}

TravelForecast TabulatedStates::forecast(const terramech::Gradient& gradient) const {
  const TravelState state = this->state(gradient);
  TravelForecast out;
  out.energy_J_per_m.fill(state.energy_J_per_m);
  out.time_s_per_m.fill(state.time_s_per_m);
  return out;
}

std::shared_ptr<const TravelStates> TabulatedStates::withAdded(double added_J_per_m) const {
  std::vector<TravelState> states = states_;
  for (TravelState& state : states) state.energy_J_per_m += static_cast<float>(added_J_per_m);
  return std::make_shared<const TabulatedStates>(std::move(states));
}

std::shared_ptr<const TravelStates> statedStates(
    const std::function<double(const terramech::Gradient&)>& cost_per_m, double max_across,
    std::uint8_t class_index) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  const int rows = static_cast<int>(std::ceil(max_across * TravelCurve::kRowsPerUnit)) + 1;
  std::vector<TravelState> states;
  for (int row = 0; row < rows; ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      const double cost =
          cost_per_m({TravelCurve::gradient(bin), static_cast<double>(row) / TravelCurve::kRowsPerUnit});
      TravelState state{.slip = unknown,
                        .sinkage_m = unknown,
                        .torque_Nm = unknown,
                        .energy_J_per_m = static_cast<float>(cost),
                        .time_s_per_m = unknown,
                        .risk_per_m = unknown,
                        .pull_margin = unknown,
                        .refusal = std::isfinite(cost) ? Refusal::None : Refusal::Stated,
                        .class_index = class_index};
      if (row > 0) {
        const TravelState& before = states[states.size() - TravelCurve::kBins];
        state.energy_J_per_m = std::max(state.energy_J_per_m, before.energy_J_per_m);
        if (before.refusal != Refusal::None) state.refusal = before.refusal;
      }
      states.push_back(state);
    }
  return std::make_shared<const TabulatedStates>(std::move(states));
}

}  // namespace talus::costmap
