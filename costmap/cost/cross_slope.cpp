#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <talus/common/constants.hpp>
#include <talus/costmap/cost/cross_slope.hpp>

namespace talus::costmap {
namespace {

using terramech::Gradient;
using terramech::SlopeState;

constexpr double kAlongStep = 1.0 / 32.0;   // between gradients along at which a row is solved
constexpr double kLevelStep = 1.0 / 128.0;  // the same without anything across
constexpr double kRowStep = 1.0 / DriveCurve::kRowsPerUnit;
constexpr double kBinStep = 1.0 / 256.0;
constexpr double kSpare = 1.25;  // rows beyond the limit, to know how far off failure is
constexpr int kBins = DriveCurve::kBins;
constexpr double kBelow = 0.16;   // gradients downhill beyond the limit, to know how far off failure is
constexpr double kNowhere = 4.0;  // steeper than any cell

// What holds in a row: gradients along from first to last, and the states on the lattice between them.
struct Row {
  double first = 0.0, last = -1.0;  // infinite where they lie beyond the lattice
  int first_node = 0;
  std::vector<SlopeState> states;
};

// Solves rows on a lattice of gradients along.
class Rows {
 public:
  Rows(const terramech::SlopeEquilibrium& equilibrium, double low, double high, double step)
      : equilibrium_(equilibrium),
        step_(step),
        low_(static_cast<int>(std::floor(low / step))),
        high_(static_cast<int>(std::ceil(high / step))) {}

  // The longest range that holds; none: nothing does.
  std::optional<Row> solved(double across) const {
    std::optional<Row> best;
    Row run;
    for (int node = low_; node <= high_; ++node) {
      const SlopeState state = at(node * step_, across);
      if (!state.holds()) {
        run.states.clear();
        continue;
      }
      if (run.states.empty()) run.first_node = node;
      run.states.push_back(state);
      if (!best || run.states.size() > best->states.size()) best = run;
    }
    if (!best) return best;
    const int last_node = best->first_node + static_cast<int>(best->states.size()) - 1;
    best->first = best->first_node > low_ ? edge(best->first_node, -1, across) : -kInfinity;
    best->last = last_node < high_ ? edge(last_node, 1, across) : kInfinity;
    return best;
  }

 private:
  // Of a rover whose left and right differ, on the slope to the worse side.
  SlopeState at(double along, double across) const {
    const SlopeState left = equilibrium_.at({along, across});
    if (equilibrium_.symmetric() || !left.holds()) return left;
    const SlopeState right = equilibrium_.at({along, -across});
    return right.holds() && right.energy_J_per_m < left.energy_J_per_m ? left : right;
  }

  // The last gradient that holds from a node towards its neighbour, which does not.
  double edge(int node, int towards, double across) const {
    double holds = node * step_, fails = (node + towards) * step_;
    for (int halving = 0; halving < 5; ++halving) {
      const double middle = 0.5 * (holds + fails);
      (at(middle, across).holds() ? holds : fails) = middle;
    }
    return holds;
  }

  const terramech::SlopeEquilibrium& equilibrium_;
  double step_;
  int low_, high_;
};

// The climbs without crossing that cost as much as a state.
class LevelCosts {
 public:
  LevelCosts(const std::optional<Row>& level, double last) : last_(last) {
    if (!level) return;
    first_node_ = level->first_node;
    double energy = 0.0, time = 0.0;
    for (const SlopeState& s : level->states) {
      energies_.push_back(energy = std::max(energy, s.energy_J_per_m));
      times_.push_back(time = std::max(time, 1.0 / s.speed_mps));
    }
  }

  // By how much steeper than each lattice gradient of a row.
  std::vector<double> surcharges(const Row& row) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < row.states.size(); ++k) {
      const SlopeState& state = row.states[k];
      const double along = (row.first_node + static_cast<double>(k)) * kAlongStep;
      const double needed =
          std::max(reached(energies_, state.energy_J_per_m), reached(times_, 1.0 / state.speed_mps));
      all.push_back(std::max(0.0, std::min(needed, last_) - along));
    }
    return all;
  }

 private:
  double reached(const std::vector<double>& values, double value) const {
    const auto next = std::ranges::lower_bound(values, value);
    if (next == values.end()) return kInfinity;
    const auto k = next - values.begin();
    const double from = k == 0 ? value : values[static_cast<std::size_t>(k - 1)];
    const double back = *next > from ? (*next - value) / (*next - from) : 0.0;
    return (first_node_ + static_cast<double>(k) - back) * kLevelStep;
  }

  int first_node_ = 0;
  double last_;
  std::vector<double> energies_, times_;
};

// Lattice gradients by linear interpolation, constant beyond the ends.
double interpolated(const std::vector<double>& values, double at) {
  const double x = std::clamp(at, 0.0, static_cast<double>(values.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(x), values.size() - 1);
  const auto next = std::min(k + 1, values.size() - 1);
  return values[k] + (x - static_cast<double>(k)) * (values[next] - values[k]);
}

// The strength that ground may lose until nothing holds, by halving: what is lost of the pull adds to the climb,
// what is lost of the side force makes the slope across count for more.
double strengthToLose(double along, double across, const CrossSlope::Level& level,
                      const std::vector<double>& losses) {
  const auto fails = [&](double lost) {
    const double row = across / (1.0 - lost / level.thrust) / kRowStep;
    return row > static_cast<double>(losses.size() - 1) ||
           along + lost + interpolated(losses, row) > level.last;
  };
  double low = -2.0, high = std::min(level.thrust * (1.0 - 1e-9), level.last - along);
  if (high <= low || !fails(high)) return std::max(high, low);
  for (int halving = 0; halving < 16; ++halving) {
    const double middle = 0.5 * (low + high);
    (fails(middle) ? high : low) = middle;
  }
  return low;
}

std::int16_t binAbove(double gradient) {
  const double bin = std::ceil(gradient / kBinStep - 1e-6) + kBins / 2;
  return static_cast<std::int16_t>(std::clamp(bin, 0.0, static_cast<double>(kBins)));
}

// Greatest of any range of values, in tables of powers of two.
class RangeMaximum {
 public:
  explicit RangeMaximum(std::vector<double> values) : levels_{std::move(values)} {
    for (std::size_t width = 1; 2 * width <= levels_[0].size(); width *= 2) {
      const std::vector<double>& half = levels_.back();
      std::vector<double> both(half.size() - width);
      for (std::size_t i = 0; i < both.size(); ++i) both[i] = std::max(half[i], half[i + width]);
      levels_.push_back(std::move(both));
    }
  }

  double operator()(int first, int last) const noexcept {
    int level = 0;
    while (2 << level <= last - first + 1) ++level;
    const std::vector<double>& of = levels_[static_cast<std::size_t>(level)];
    return std::max(of[static_cast<std::size_t>(first)],
                    of[static_cast<std::size_t>(last - (1 << level) + 1)]);
  }

 private:
  std::vector<std::vector<double>> levels_;
};

float weighed(double energy_J_per_m, double time_s_per_m, double risk_per_m, const CostWeights& weights) {
  return static_cast<float>(weights.energy * energy_J_per_m + weights.time_W * time_s_per_m +
                            weights.risk_J * risk_per_m);
}

double riskOf(const DriveState& state) noexcept {
  return state.refusal == Refusal::None ? static_cast<double>(state.risk_per_m) : kInfinity;
}

}  // namespace

CrossSlope::CrossSlope(const terramech::SlopeEquilibrium& equilibrium, const Level& level,
                       const DriveCost::Limits& limits) {
  addLevelRow();
  // Beyond 45 degrees across nothing is said to hold.
  const int needed = DriveCurve::row(std::min(limits.max_across, 1.0 + kRowStep));
  const double low = -std::min(limits.max_along + kBelow, 1.0),
               high = std::clamp(level.last + kAlongStep, 0.0, 1.0);
  const Rows rows(equilibrium, low, high, kAlongStep);
  const std::optional<Row> straight = level.first <= level.last ? rows.solved(0.0) : std::nullopt;
  const auto keep = [this](const Row& row) {
    Held& kept = held_.emplace_back();
    kept.first_node = row.first_node;
    for (const SlopeState& s : row.states)
      kept.nodes.push_back({s.slip_angle_rad, s.side_force_over_load, s.stability_margin_rad});
  };
  if (straight) keep(*straight);
  std::vector<Row> held;
  std::vector<double> losses{0.0};
  for (int row = 1; straight && row <= static_cast<int>(kSpare * needed); ++row) {
    auto solved = rows.solved(row * kRowStep);
    if (!solved) break;
    keep(*solved);
    losses.push_back(std::max(losses.back(), level.last - solved->last));
    held.push_back(std::move(*solved));
  }
  const LevelCosts costs(straight ? Rows(equilibrium, low, high, kLevelStep).solved(0.0) : straight,
                         level.last);
  double gain = 0.0;
  for (int row = 1; row <= needed; ++row) {
    if (row > static_cast<int>(held.size()) || row > DriveCurve::kRowsPerUnit) {
      climbs_.resize(climbs_.size() + kBins);
      break;
    }
    const Row& here = held[static_cast<std::size_t>(row - 1)];
    gain = std::max(gain, here.first - level.first);
    const std::vector<double> dearer = costs.surcharges(here);
    for (int bin = 0; bin < kBins; ++bin) {
      const double along = DriveCurve::gradient(bin);
      Climbs climbs;
      if (std::abs(along) <= limits.max_along + kBinStep && along - gain >= -1.0)
        climbs = {binAbove(along + interpolated(dearer, along / kAlongStep - here.first_node)),
                  binAbove(level.last - strengthToLose(along, row * kRowStep, level, losses)),
                  static_cast<std::int16_t>(kBins - binAbove(gain - along))};
      climbs_.push_back(harder(climbs, at(row - 1, bin)));
    }
  }
  tabulateSteepest();
}

CrossSlope CrossSlope::alongOnly() {
  CrossSlope none;
  none.addLevelRow();
  none.tabulateSteepest();
  return none;
}

void CrossSlope::addLevelRow() {
  for (std::int16_t bin = 0; bin < kBins; ++bin) climbs_.push_back({bin, bin, bin});
}

CrossSlope::Climbs CrossSlope::harder(const Climbs& a, const Climbs& b) noexcept {
  return {std::max(a.costs, b.costs), std::max(a.leaves, b.leaves), std::min(a.brakes, b.brakes)};
}

CrossSlope CrossSlope::harder(const CrossSlope& a, const CrossSlope& b) {
  CrossSlope both;
  both.held_ = a.held_;
  for (int row = 0; row < std::max(a.rows(), b.rows()); ++row)
    for (int bin = 0; bin < kBins; ++bin)
      both.climbs_.push_back(
          harder(a.at(std::min(row, a.rows() - 1), bin), b.at(std::min(row, b.rows() - 1), bin)));
  both.tabulateSteepest();
  return both;
}

SlopeHold CrossSlope::hold(const Gradient& gradient) const noexcept {
  const auto row = static_cast<std::size_t>(DriveCurve::row(gradient.across));
  if (row >= held_.size()) return {};
  const Held& held = held_[row];
  const double x = gradient.along / kAlongStep - held.first_node;
  const double most = static_cast<double>(held.nodes.size()) - 1.0;
  if (!(x >= -1.0 && x <= most + 1.0)) return {};
  const double at = std::clamp(x, 0.0, most);
  const auto k = static_cast<std::size_t>(at), next = std::min(k + 1, held.nodes.size() - 1);
  const double share = at - static_cast<double>(k);
  const auto between = [&](auto field) {
    return held.nodes[k].*field + share * (held.nodes[next].*field - held.nodes[k].*field);
  };
  return {std::copysign(between(&SlopeHold::slip_angle_rad), gradient.across),
          between(&SlopeHold::side_force_over_load), between(&SlopeHold::stability_margin_rad)};
}

void CrossSlope::tabulateSteepest() {
  constexpr int kHeadings = 24;  // over half a turn: left and right count alike
  for (int step = 0; step <= 1024; ++step) {
    const double gradient = step * CellCode::kStep;
    double most = gradient;
    for (int k = 1; k < kHeadings; ++k) {
      const double heading = k * std::numbers::pi / kHeadings;
      const int row = std::min(DriveCurve::row(gradient * std::sin(heading)), rows() - 1);
      const int bin = std::min(DriveCurve::bin(gradient * std::cos(heading)), kBins - 1);
      const int leaves = at(row, bin).leaves;
      most = std::max(most, leaves < kBins ? DriveCurve::gradient(leaves) : kNowhere);
    }
    steepest_.push_back(static_cast<float>(most));
  }
}

double CrossSlope::climb(const Gradient& gradient) const noexcept {
  const int bin = DriveCurve::bin(gradient.along);
  if (bin < 0 || bin >= kBins) return kNowhere;
  const int leaves = at(std::min(DriveCurve::row(gradient.across), rows() - 1), bin).leaves;
  return leaves < kBins ? DriveCurve::gradient(leaves) : kNowhere;
}

double CrossSlope::steepest(double gradient) const noexcept {
  const double step = gradient / CellCode::kStep;
  if (!(step <= 1024.0)) return gradient;
  return std::max(gradient, static_cast<double>(steepest_[static_cast<std::size_t>(std::ceil(step))]));
}

DriveState CrossSlope::state(const DriveTable& states, int row, int bin) const noexcept {
  const Climbs climbs = at(std::min(row, rows() - 1), bin);
  DriveState out = states[static_cast<std::size_t>(bin)];
  if (climbs.leaves == kBins) {
    if (out.refusal == Refusal::None) out.refusal = Refusal::SideForce;
    return out;
  }
  const DriveState own = out;
  for (int k = bin; k <= std::min<int>(climbs.costs, kBins - 1); ++k) {
    const DriveState climb = worse(out, states[static_cast<std::size_t>(k)]);
    out = own;
    out.energy_J_per_m = climb.energy_J_per_m;
    out.time_s_per_m = climb.time_s_per_m;
    out.slip = climb.slip;
    out.sinkage_m = climb.sinkage_m;
    out.torque_Nm = climb.torque_Nm;
  }
  for (int k = climbs.brakes; k <= climbs.leaves; ++k) {
    const DriveState& climb = states[static_cast<std::size_t>(k)];
    out.risk_per_m = std::max(out.risk_per_m, climb.risk_per_m);
    out.weak = std::max(out.weak, climb.weak);
    if (k < bin) continue;
    out.pull_margin = std::min(out.pull_margin, climb.pull_margin);
    out.category = std::max(out.category, climb.category);
  }
  for (int k = climbs.brakes; k <= climbs.leaves && out.refusal == Refusal::None; ++k)
    out.refusal = states[static_cast<std::size_t>(k)].refusal;
  if (own.refusal == Refusal::None && out.refusal == Refusal::Pull) out.refusal = Refusal::SideForce;
  return out;
}

std::shared_ptr<const std::vector<float>> CrossSlope::costs(const DriveTable& states,
                                                            const CostWeights& weights) const {
  const auto maximum = [&](auto value) {
    std::vector<double> values;
    for (const DriveState& state : states) values.push_back(static_cast<double>(value(state)));
    return RangeMaximum(std::move(values));
  };
  const RangeMaximum energy = maximum([](const DriveState&s) { return s.energy_J_per_m; }),
                     time = maximum([](const DriveState&s) { return s.time_s_per_m; }),
                     risk = maximum(riskOf);
  auto costs = std::make_shared<std::vector<float>>(climbs_.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < climbs_.size(); ++i) {
    const Climbs& climbs = climbs_[i];
    if (climbs.leaves == kBins) continue;
    const int bin = static_cast<int>(i % kBins), dearest = std::min<int>(climbs.costs, kBins - 1);
    const double chance = risk(climbs.brakes, climbs.leaves);
    if (chance < kInfinity) (*costs)[i] = weighed(energy(bin, dearest), time(bin, dearest), chance, weights);
  }
  return costs;
}

DriveCurve priced(const DriveTable& states, const CrossSlope* crossing, const CostWeights& weights) {
  DriveCurve curve;
  for (std::size_t bin = 0; bin < states.size(); ++bin) {
    const DriveState& s = states[bin];
    const double risk = riskOf(s);
    curve.cost_J_per_m[bin] = risk < kInfinity ? weighed(static_cast<double>(s.energy_J_per_m),
                                                         static_cast<double>(s.time_s_per_m), risk, weights)
                                               : std::numeric_limits<float>::infinity();
  }
  if (crossing && crossing->rows() > 1) curve.crossing = crossing->costs(states, weights);
  return curve;
}

}  // namespace talus::costmap
