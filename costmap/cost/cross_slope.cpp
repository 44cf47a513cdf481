#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <talus/common/constants.hpp>
#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/cost/level_climbs.hpp>
#include <talus/costmap/cost/slope_rows.hpp>

namespace talus::costmap {
namespace {

using terramech::Gradient;
using terramech::SlopeFailure;
using terramech::SlopeState;

constexpr double kAlongStep = 1.0 / 32.0;   // step of the gradients along the heading in a row
constexpr double kLevelStep = 1.0 / 128.0;  // step in row 0 under even loads
constexpr double kRowStep = 1.0 / TravelCurve::kRowsPerUnit;
constexpr double kSpare = 1.25;  // factor on the number of rows, to find failures beyond the roll limit
constexpr int kBins = TravelCurve::kBins;
constexpr double kBelow = 0.16;        // gradient solved beyond the pitch limit, to find failures of descents
constexpr double kNowhere = 4.0;       // steeper than any cell
constexpr double kUpright_rad = 2e-4;  // interpolation error bound of the stability margin
constexpr float kSamePlace = 0.02F;    // [bins]

// Returns the fractional bin index of a gradient, clamped to the table.
float placeOf(double gradient) {
  return static_cast<float>(std::clamp(gradient * TravelCurve::kBinsPerUnit + kBins / 2, 0.0, kBins - 1.0));
}

// A position between nodes; positions within kSamePlace of a node are on the node.
struct Place {
  int whole;
  float share;
};
Place placed(float place) noexcept {
  const int whole = static_cast<int>(place);
  const float share = place - static_cast<float>(whole);
  if (share < kSamePlace) return {whole, 0.0F};
  return share > 1.0F - kSamePlace ? Place{whole + 1, 0.0F} : Place{whole, share};
}

Refusal reasonOf(SlopeFailure failure) noexcept {
  switch (failure) {
    case SlopeFailure::Tips:
      return Refusal::Tips;
    case SlopeFailure::Sinks:
      return Refusal::Sinkage;
    case SlopeFailure::CannotPull:
      return Refusal::Pull;
    case SlopeFailure::Torque:
      return Refusal::Torque;
    default:
      return Refusal::SideForce;
  }
}

// Maximum over any range of values by a sparse table (ranges of power-of-two length).
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

  // Maximum over the positions from `from` to `to`, linear between values.
  double operator()(float from, float to) const noexcept {
    const Place a = placed(from), b = placed(to);
    const int first = a.whole + static_cast<int>(a.share > 0.0F);
    double most = std::max(at(a), at(b));
    if (first <= b.whole) most = std::max(most, among(first, b.whole));
    return most;
  }

 private:
  double at(const Place& place) const noexcept {
    const double* value = &levels_[0][static_cast<std::size_t>(place.whole)];
    if (place.share == 0.0F) return value[0];
    if (!(value[0] < kInfinity && value[1] < kInfinity)) return kInfinity;
    return value[0] + static_cast<double>(place.share) * (value[1] - value[0]);
  }

  double among(int first, int last) const noexcept {
    int level = 0;
    while (2 << level <= last - first + 1) ++level;
    const std::vector<double>& of = levels_[static_cast<std::size_t>(level)];
    return std::max(of[static_cast<std::size_t>(first)],
                    of[static_cast<std::size_t>(last - (1 << level) + 1)]);
  }

  std::vector<std::vector<double>> levels_;
};

// Calls `each` for the states at both positions and at all nodes between the positions.
template <typename Each>
void overPlaces(const TravelTable& states, float from, float to, Each each) {
  const Place a = placed(from), b = placed(to);
  const auto at = [&](const Place& place) {
    const TravelState& state = states[static_cast<std::size_t>(place.whole)];
    return place.share > 0.0F ? between(state, states[static_cast<std::size_t>(place.whole + 1)], place.share)
                              : state;
  };
  each(at(a));
  for (int k = a.whole + static_cast<int>(a.share > 0.0F); k <= b.whole; ++k)
    each(states[static_cast<std::size_t>(k)]);
  each(at(b));
}

float farther(float a, float b) noexcept {
  return std::abs(a) < std::abs(b) ? b : a;
}

SlopeHold mixed(const SlopeHold& a, const SlopeHold& b, double share) noexcept {
  SlopeHold out = a;
  for (const auto number :
       {&SlopeHold::slip_angle_rad, &SlopeHold::side_force_over_load, &SlopeHold::stability_margin_rad})
    out.*number += share * (b.*number - a.*number);
  return out;
}

float weighed(double energy_J_per_m, double time_s_per_m, double risk_per_m, const CostWeights& weights) {
  return static_cast<float>(weights.energy * energy_J_per_m + weights.time_W * time_s_per_m +
                            weights.risk_J * risk_per_m);
}

double riskOf(const TravelState& state) noexcept {
  return state.refusal == Refusal::None ? static_cast<double>(state.risk_per_m) : kInfinity;
}

}  // namespace

struct CrossSlope::Strengths {
  std::vector<SlopeRow> rows;         // the last row may have no state
  std::vector<double> losses, gains;  // of the steepest climb and descent, for each row with states
};

CrossSlope::Strengths CrossSlope::solvedRows(const SlopeRows& lattice, const SlopeRows& even_lattice,
                                             const Ends& even, int last_row) {
  Strengths all;
  for (int row = 0; row <= last_row; ++row) {
    all.rows.push_back(lattice.solved(row * kRowStep));
    const SlopeRow &here = all.rows.back(), even_here = even_lattice.solved(row * kRowStep);
    if (here.states.empty() || even_here.states.empty()) break;
    // If tipping limits a row, the strength limit is that under even loads.
    const double strong_to = here.tips_behind ? even_here.last : here.last,
                 strong_from = here.tips_before ? even_here.first : here.first;
    all.losses.push_back(std::max(all.losses.empty() ? 0.0 : all.losses.back(), even.last - strong_to));
    all.gains.push_back(std::max(all.gains.empty() ? 0.0 : all.gains.back(), strong_from - even.first));
  }
  return all;
}

void CrossSlope::addRow(int row, const Strengths& strengths, const LevelClimbs& level_climbs,
                        const Level& level, const TravelCost::Limits& limits) {
  const SlopeRow& here = strengths.rows[static_cast<std::size_t>(row)];
  const double gain = strengths.gains[static_cast<std::size_t>(row)];
  const LevelClimbs::Surcharges dearer = level_climbs.surcharges(here);
  for (int bin = 0; bin < kBins; ++bin) {
    const double along = TravelCurve::gradient(bin), node = along / kAlongStep - here.first_node;
    Climbs climbs;
    if (std::abs(along) > limits.max_along + 2.0 / TravelCurve::kBinsPerUnit)
      climbs.refused = Refusal::Pitch;
    else if (here.margin_rad(along) < kUpright_rad)
      climbs.refused = here.holds(along) ? Refusal::Tips : reasonAt(row, bin);
    else if (along - gain < -1.0 || (here.tips_before && along < here.first) ||
             (here.tips_behind && along > here.last))
      climbs.refused = reasonAt(row, bin);
    else
      climbs = {.costs = placeOf(along + interpolated(dearer.climb, node)),
                .leaves = placeOf(level.last - strengthToLose(along, row * kRowStep,
                                                              {level.last, level.thrust}, strengths.losses)),
                .brakes = placeOf(along - gain),
                .more_slip = static_cast<float>(interpolated(dearer.slip, node))};
    climbs_.push_back(row == 0 ? climbs : harder(climbs, at(row - 1, bin)));
  }
}

CrossSlope::CrossSlope(const terramech::SlopeEquilibrium& equilibrium, const Level& level,
                       const TravelCost::Limits& limits) {
  // Interpolation at the roll limit needs the row beyond. Gradients across are at most 1.
  const int needed = static_cast<int>(std::min(limits.max_across, 1.0) * TravelCurve::kRowsPerUnit) + 1;
  const double low = -std::min(limits.max_along + kBelow, 1.0),
               high = std::clamp(level.last + kAlongStep, 0.0, 1.0);
  const terramech::SlopeEquilibrium even_equilibrium = equilibrium.withEvenLoads();
  const SlopeRow even = SlopeRows(even_equilibrium, low, high, kLevelStep).solved(0.0);
  if (level.first > level.last || even.states.empty()) {  // the states of the curve refuse row 0
    addLevelRow();
    climbs_.resize(2 * kBins, Climbs{.refused = Refusal::Pull});
    tabulateSteepest();
    return;
  }
  const double first = std::isfinite(even.first) ? even.first : level.first,
               last = std::isfinite(even.last) ? even.last : level.last;
  const SlopeRows lattice(equilibrium, low, high, kAlongStep),
      even_lattice(even_equilibrium, low, high, kAlongStep);
  first_along_ = lattice.low();
  const Strengths strengths =
      solvedRows(lattice, even_lattice, {first, last}, static_cast<int>(kSpare * needed));
  for (const SlopeRow& row : strengths.rows) {
    std::vector<Held>& kept = held_.emplace_back();
    for (const SlopeState& s : row.all)
      kept.push_back({{s.slip_angle_rad, s.side_force_over_load, s.stability_margin_rad}, s.grip});
  }
  const LevelClimbs level_climbs(even, level.last);
  for (int row = 0; row <= std::min(needed, TravelCurve::kRowsPerUnit + 1); ++row)
    if (row < static_cast<int>(strengths.losses.size())) addRow(row, strengths, level_climbs, level, limits);
  if (rows() <= needed) {
    const int row = rows();
    for (int bin = 0; bin < kBins; ++bin) {
      const Climbs climbs{.refused = reasonAt(row, bin)};
      climbs_.push_back(row == 0 ? climbs : harder(climbs_[climbs_.size() - kBins], climbs));
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
  for (int bin = 0; bin < kBins; ++bin) {
    const auto place = static_cast<float>(bin);
    climbs_.push_back({.costs = place, .leaves = place, .brakes = place});
  }
}

CrossSlope::Climbs CrossSlope::harder(const Climbs& a, const Climbs& b) noexcept {
  return {.costs = std::max(a.costs, b.costs),
          .leaves = std::max(a.leaves, b.leaves),
          .brakes = std::min(a.brakes, b.brakes),
          .more_slip = a.costs < b.costs ? b.more_slip : a.more_slip,
          .refused = a.refused != Refusal::None ? a.refused : b.refused};
}

CrossSlope CrossSlope::harder(const CrossSlope& a, const CrossSlope& b) {
  CrossSlope both;
  both.held_ = a.held_;
  both.first_along_ = a.first_along_;
  for (int row = 0; row < std::max(a.rows(), b.rows()); ++row)
    for (int bin = 0; bin < kBins; ++bin) both.climbs_.push_back(harder(a.at(row, bin), b.at(row, bin)));
  both.tabulateSteepest();
  return both;
}

// Reason why the nearer, or else the other, table node has no equilibrium; Pull or SideForce if both have one.
Refusal CrossSlope::reasonAt(int row, int bin) const noexcept {
  const Refusal lacks = row == 0 ? Refusal::Pull : Refusal::SideForce;
  if (held_.empty()) return lacks;
  const std::vector<Held>& held = held_[std::min(static_cast<std::size_t>(row), held_.size() - 1)];
  const double place = std::clamp(TravelCurve::gradient(bin) / kAlongStep - first_along_, 0.0,
                                  static_cast<double>(held.size()) - 1.0);
  const auto k = static_cast<std::size_t>(place);
  const Held &low = held[k], &high = held[std::min(k + 1, held.size() - 1)];
  const double share = place - static_cast<double>(k);
  if (mixed(low.hold, high.hold, share).stability_margin_rad < 0.0) return Refusal::Tips;
  const SlopeFailure nearer = (share < 0.5 ? low : high).grip, other = (share < 0.5 ? high : low).grip;
  if (nearer != SlopeFailure::None) return reasonOf(nearer);
  return other != SlopeFailure::None ? reasonOf(other) : lacks;
}

// Interpolates linearly between the adjacent equilibria; skips a failed equilibrium.
SlopeHold CrossSlope::holdInRow(int row, double along) const noexcept {
  if (row >= static_cast<int>(held_.size())) return {};
  const std::vector<Held>& held = held_[static_cast<std::size_t>(row)];
  const double place = along / kAlongStep - first_along_, most = static_cast<double>(held.size()) - 1.0;
  if (!(place >= -1.0 && place <= most + 1.0)) return {};
  const double at = std::clamp(place, 0.0, most);
  const auto k = static_cast<std::size_t>(at), next = std::min(k + 1, held.size() - 1);
  const Held &a = held[k], &b = held[next];
  if (a.grip != SlopeFailure::None) return b.grip != SlopeFailure::None ? SlopeHold{} : b.hold;
  return b.grip != SlopeFailure::None ? a.hold : mixed(a.hold, b.hold, at - static_cast<double>(k));
}

SlopeHold CrossSlope::hold(const Gradient& gradient) const noexcept {
  const auto row = TravelCurve::between(std::abs(gradient.across) * TravelCurve::kRowsPerUnit);
  SlopeHold out = holdInRow(row.whole, gradient.along);
  if (row.share > 0.0F)
    out = mixed(out, holdInRow(row.whole + 1, gradient.along), static_cast<double>(row.share));
  out.slip_angle_rad = std::copysign(out.slip_angle_rad, 0.0 - gradient.across);
  return out;
}

void CrossSlope::tabulateSteepest() {
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

double CrossSlope::climb(const Gradient& gradient) const noexcept {
  const double place = gradient.along * TravelCurve::kBinsPerUnit + kBins / 2;
  if (!(place >= 0.0 && place < TravelCurve::kLastPlace)) return kNowhere;
  const auto bin = TravelCurve::between(place),
             row = TravelCurve::between(std::abs(gradient.across) * TravelCurve::kRowsPerUnit);
  bool refused = false;
  const auto leaves = [&](int r) {
    const Climbs &a = at(r, bin.whole), &b = at(r, bin.whole + static_cast<int>(bin.share > 0.0F));
    refused = refused || a.refused != Refusal::None || b.refused != Refusal::None;
    return a.leaves + bin.share * (b.leaves - a.leaves);
  };
  const float low = leaves(row.whole), high = leaves(row.whole + static_cast<int>(row.share > 0.0F));
  return refused ? kNowhere : TravelCurve::gradient(static_cast<double>(low + row.share * (high - low)));
}

double CrossSlope::steepest(double gradient) const noexcept {
  const double step = gradient / CellCode::kStep;
  if (!(step <= 1024.0)) return gradient;
  return std::max(gradient, static_cast<double>(steepest_[static_cast<std::size_t>(std::ceil(step))]));
}

TravelState CrossSlope::state(const TravelTable& states, int row, int bin) const noexcept {
  const Climbs& climbs = at(row, bin);
  TravelState out = states[static_cast<std::size_t>(bin)];
  if (climbs.refused != Refusal::None) {
    if (out.refusal == Refusal::None) out.refusal = climbs.refused;
    return out;
  }
  const TravelState own = out;
  const auto here = static_cast<float>(bin);
  overPlaces(states, here, climbs.costs, [&](const TravelState& climb) {
    out.energy_J_per_m = std::max(out.energy_J_per_m, climb.energy_J_per_m);
    out.time_s_per_m = std::max(out.time_s_per_m, climb.time_s_per_m);
    out.slip = climb.slip;
    out.sinkage_m = std::max(out.sinkage_m, climb.sinkage_m);
    out.torque_Nm = farther(out.torque_Nm, climb.torque_Nm);
  });
  out.slip = std::clamp(out.slip + climbs.more_slip, -1.0F, 1.0F);
  overPlaces(states, here, climbs.leaves, [&](const TravelState& climb) {
    out.pull_margin = std::min(out.pull_margin, climb.pull_margin);
    out.category = std::max(out.category, climb.category);
  });
  overPlaces(states, climbs.brakes, climbs.leaves, [&](const TravelState& climb) {
    out.risk_per_m = std::max(out.risk_per_m, climb.risk_per_m);
    out.weak = std::max(out.weak, climb.weak);
    if (out.refusal == Refusal::None) out.refusal = climb.refusal;
  });
  if (own.refusal == Refusal::None && out.refusal == Refusal::Pull) out.refusal = reasonAt(row, bin);
  return out;
}

std::shared_ptr<const std::vector<float>> CrossSlope::costs(const TravelTable& states,
                                                            const CostWeights& weights) const {
  const auto maximum = [&](auto value) {
    std::vector<double> values;
    for (const TravelState& state : states) values.push_back(static_cast<double>(value(state)));
    return RangeMaximum(std::move(values));
  };
  const RangeMaximum energy = maximum([](const TravelState&s) { return s.energy_J_per_m; }),
                     time = maximum([](const TravelState&s) { return s.time_s_per_m; }),
                     risk = maximum(riskOf);
  auto costs = std::make_shared<std::vector<float>>(climbs_.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < climbs_.size(); ++i) {
    const Climbs& climbs = climbs_[i];
    if (climbs.refused != Refusal::None) continue;
    const auto here = static_cast<float>(i % kBins);
    const double chance = risk(climbs.brakes, climbs.leaves);
    if (chance < kInfinity)
      (*costs)[i] = weighed(energy(here, climbs.costs), time(here, climbs.costs), chance, weights);
  }
  return costs;
}

TravelCurve priced(const TravelTable& states, const CrossSlope* crossing, const CostWeights& weights) {
  TravelCurve curve;
  if (crossing) {
    const auto costs = crossing->costs(states, weights);
    std::copy_n(costs->begin(), kBins, curve.cost_J_per_m.begin());
    if (crossing->rows() > 1) curve.crossing = costs;
    return curve;
  }
  for (std::size_t bin = 0; bin < states.size(); ++bin) {
    const TravelState& s = states[bin];
    const double risk = riskOf(s);
    curve.cost_J_per_m[bin] = risk < kInfinity ? weighed(static_cast<double>(s.energy_J_per_m),
                                                         static_cast<double>(s.time_s_per_m), risk, weights)
                                               : std::numeric_limits<float>::infinity();
  }
  return curve;
}

}  // namespace talus::costmap
