#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/common/constants.hpp>
#include <talus/costmap/cost/slope_rows.hpp>

namespace talus::costmap {

using terramech::SlopeFailure;
using terramech::SlopeState;

namespace {

constexpr double kNear_rad = 0.1;  // margin below which one axle or side carries nearly the whole load (ours)

}  // namespace

// Beyond the tabulated gradients, the margin decreases by 1 rad per unit of gradient, an upper bound of the
// change of angle.
double SlopeRow::margin_rad(double along) const {
  if (margins_rad.empty()) return kNaN;
  if (along <= margins_rad.front().first)
    return margins_rad.front().second - (margins_rad.front().first - along);
  if (along >= margins_rad.back().first)
    return margins_rad.back().second - (along - margins_rad.back().first);
  const auto next = std::ranges::upper_bound(margins_rad, along, {}, &std::pair<double, double>::first);
  const auto& [a, at_a] = *(next - 1);
  const auto& [b, at_b] = *next;
  return at_a + (along - a) / (b - a) * (at_b - at_a);
}

SlopeRows::SlopeRows(const terramech::SlopeEquilibrium& equilibrium, double low, double high, double step)
    : equilibrium_(equilibrium),
      step_(step),
      low_(static_cast<int>(std::floor(low / step))),
      high_(static_cast<int>(std::ceil(high / step))) {}

SlopeRow SlopeRows::solved(double across) const {
  SlopeRow row{.step = step_};
  // Selects the interval nearest to level ground; of equally near intervals, the longest.
  std::size_t begin = 0, length = 0, most = 0;
  int nearest = std::numeric_limits<int>::max();
  for (int node = low_; node <= high_; ++node) {
    row.all.push_back(at(node * step_, across));
    length = row.all.back().grip == SlopeFailure::None ? length + 1 : 0;
    if (length == 0) continue;
    const int from = node - static_cast<int>(length) + 1, off = std::max({from, -node, 0});
    if (off > nearest || (off == nearest && length <= most)) continue;
    nearest = off;
    most = length;
    begin = row.all.size() - length;
  }
  if (most == 0) return row;
  row.first_node = low_ + static_cast<int>(begin);
  const int last_node = row.first_node + static_cast<int>(most) - 1;
  row.states.assign(row.all.begin() + static_cast<std::ptrdiff_t>(begin),
                    row.all.begin() + static_cast<std::ptrdiff_t>(begin + most));
  row.first = row.first_node > low_ ? edge(row.first_node, -1, across) : -kInfinity;
  row.last = last_node < high_ ? edge(last_node, 1, across) : kInfinity;
  const auto add = [&](double along, const SlopeState& state) {
    row.margins_rad.emplace_back(along, state.stability_margin_rad);
  };
  if (std::isfinite(row.first) && row.first < row.first_node * step_) add(row.first, at(row.first, across));
  for (std::size_t k = 0; k < most; ++k) add((row.first_node + static_cast<int>(k)) * step_, row.states[k]);
  if (std::isfinite(row.last) && row.last > last_node * step_) add(row.last, at(row.last, across));
  row.tips_before = std::isfinite(row.first) && row.margins_rad.front().second < kNear_rad;
  row.tips_behind = std::isfinite(row.last) && row.margins_rad.back().second < kNear_rad;
  return row;
}

SlopeState SlopeRows::at(double along, double across) const {
  SlopeState left = equilibrium_.at({along, across});
  if (equilibrium_.symmetric()) return left;
  SlopeState right = equilibrium_.at({along, -across});
  left.stability_margin_rad = right.stability_margin_rad =
      std::min(left.stability_margin_rad, right.stability_margin_rad);
  if (left.grip != SlopeFailure::None) return left;
  return right.grip == SlopeFailure::None && right.energy_J_per_m < left.energy_J_per_m ? left : right;
}

// Finds by bisection the last gradient without failure between a node and its failing neighbour.
double SlopeRows::edge(int node, int towards, double across) const {
  double holds = node * step_, fails = (node + towards) * step_;
  for (int halving = 0; halving < 7; ++halving) {
    const double middle = 0.5 * (holds + fails);
    (at(middle, across).grip == SlopeFailure::None ? holds : fails) = middle;
  }
  return holds;
}

}  // namespace talus::costmap
