#include <algorithm>
#include <array>
#include <cmath>

#include <talus/costmap/cost/expected_travel.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::costmap {
namespace {

using terramech::MobilityCurve;

constexpr int kSteps = 1024;

// Seven-point Gauss-Hermite quadrature: deviations and weights of the pairs, and the weight of the mean.
constexpr std::array<double, 3> kDeviation{1.1544053947399682, 2.3667594107345416, 3.7504397177257425};
constexpr std::array<double, 3> kPairWeight{0.2401231786050127, 0.030757123967586498, 5.4826885597221781e-4};
constexpr double kMeanWeight = 0.45714285714285714;

bool drivable(const MobilityCurve& curve, double demand) {
  return curve.at(std::atan(demand)).feasible;
}

// Finds the limit between a drivable demand (`drives`) and an undrivable demand (`fails`) by bisection.
double edge(const MobilityCurve& curve, double drives, double fails) {
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (drives + fails);
    (drivable(curve, middle) ? drives : fails) = middle;
  }
  return drives;
}

// Returns the last demand from `from` towards `end` up to which all demands are drivable.
double followed(const MobilityCurve& curve, double from, double end) {
  const double step = (end - from) / kSteps;
  double last = from;
  for (int k = 1; k <= kSteps; ++k) {
    const double next = from + k * step;
    if (!drivable(curve, next)) return edge(curve, last, next);
    last = next;
  }
  return last;
}

}  // namespace

ExpectedTravel::ExpectedTravel(const MobilityCurve& curve) {
  if (curve.maxSlope_rad() < curve.minSlope_rad()) return;
  const double low = std::tan(curve.minSlope_rad()), high = std::tan(curve.maxSlope_rad());
  // Starts at level ground or, if level ground is undrivable, at the greatest drivable demand.
  double from = 0.0;
  for (int k = 0; k <= kSteps && !drivable(curve, from); ++k) from = high + k * (low - high) / kSteps;
  if (!drivable(curve, from)) return;
  first_ = followed(curve, from, low);
  last_ = followed(curve, from, high);
  step_ = (last_ - first_) / kSteps;
  const double level = std::clamp(0.0, first_, last_);
  for (int k = 0; k <= kSteps; ++k) {
    const double demand = first_ + k * step_;
    const terramech::MobilityState s = curve.at(std::atan(demand));
    const auto atLeast = [&](std::vector<double>& values, double value) {
      values.push_back(values.empty() ? value : std::max(values.back(), value));
    };
    atLeast(energy_.values, s.energy_J_per_m);
    atLeast(time_.values, 1.0 / s.speed_mps);
    sinkage_m_.push_back(demand > level ? std::max(s.sinkage_m, sinkage_m_.empty() ? 0.0 : sinkage_m_.back())
                                        : s.sinkage_m);
  }
  findBends(energy_);
  findBends(time_);
}

void ExpectedTravel::findBends(Table& table) const {
  const std::vector<double>& v = table.values;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const double after = k < kSteps ? v[k + 1] - v[k] : 0.0;
    if (after < v[k] - v[k - 1]) table.bends.push_back(first_ + static_cast<double>(k) * step_);
  }
}

double ExpectedTravel::value(const Table& table, double demand) const noexcept {
  const double at = step_ > 0.0 ? std::clamp((demand - first_) / step_, 0.0, 1.0 * kSteps) : 0.0;
  const auto k = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kSteps - 1));
  const double share = at - static_cast<double>(k);
  return table.values[k] + share * (table.values[k + 1] - table.values[k]);
}

double ExpectedTravel::expected(const Table& table, const Estimate& demand, double least) const noexcept {
  const auto pair = [&](double d) {
    return value(table, std::max(demand.value - d, least)) + value(table, std::max(demand.value + d, least));
  };
  const double middle = value(table, std::max(demand.value, least));
  std::array<double, 3> highest;
  for (std::size_t i = 0; i < highest.size(); ++i)
    highest[i] = std::max(2.0 * middle, pair(kDeviation[i] * demand.std));
  const double widest = kDeviation.back() * demand.std;
  const auto from = std::lower_bound(table.bends.begin(), table.bends.end(), demand.value - widest);
  for (auto bend = from; bend != table.bends.end() && *bend < demand.value + widest; ++bend) {
    const double d = std::abs(*bend - demand.value), sum = pair(d);
    for (std::size_t i = 0; i < highest.size(); ++i)
      if (d <= kDeviation[i] * demand.std) highest[i] = std::max(highest[i], sum);
  }
  double total = kMeanWeight * middle;
  for (std::size_t i = 0; i < highest.size(); ++i) total += kPairWeight[i] * highest[i];
  return total;
}

ExpectedCost ExpectedTravel::at(const Estimate& demand, double least) const noexcept {
  if (energy_.values.empty()) return {};
  const double short_of = demand.value - last_;
  const double fails = demand.std > 0.0 ? terramech::normalProbability(short_of / demand.std)
                       : short_of > 0.0 ? 1.0
                                        : 0.0;
  return {expected(energy_, demand, least) + fails * energy_.values.back(),
          expected(time_, demand, least) + fails * time_.values.back()};
}

double ExpectedTravel::sinkage_m(double demand) const noexcept {
  if (sinkage_m_.empty()) return 0.0;
  const double at = step_ > 0.0 ? std::clamp((demand - first_) / step_, 0.0, 1.0 * kSteps) : 0.0;
  return sinkage_m_[static_cast<std::size_t>(std::ceil(at))];
}

}  // namespace talus::costmap
