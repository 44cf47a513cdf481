#pragma once

#include <utility>
#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

/// Slope equilibria of the rover at one gradient across the heading, at equally spaced gradients along the
/// heading.
struct SlopeRow {
  double step = 1.0;  ///< step of the gradients along the heading
  /// Interval of gradients along the heading without failure; infinite if no failure lies within the
  /// tabulated gradients.
  double first = 0.0, last = -1.0;
  /// True if tipping determines `first` or `last`, respectively.
  bool tips_before = false, tips_behind = false;
  int first_node = 0;  ///< gradient of states[0], in multiples of `step`
  /// Equilibria in the interval, including those at which the rover tips.
  std::vector<terramech::SlopeState> states{};
  std::vector<terramech::SlopeState> all{};  ///< equilibria at all tabulated gradients
  /// Stability margins over the interval of `states`, as pairs of the gradient along the heading and the
  /// margin [rad].
  std::vector<std::pair<double, double>> margins_rad{};

  /// Returns true if a gradient along the heading lies within the interval without failure.
  bool holds(double along) const noexcept { return along >= first && along <= last; }

  /// Returns the stability margin [rad] at a gradient along the heading, by linear interpolation; beyond
  /// the interval, the margin decreases by 1 rad per unit of gradient. The result is NaN without
  /// equilibria, or if the height of the centre of mass is unknown.
  double margin_rad(double along) const;
};

/// Solves the slope equilibria at a gradient across the heading for all tabulated gradients along. If the
/// sides of the rover differ, each equilibrium is that of the less favourable side: the side that fails, or
/// otherwise the side with the higher energy.
class SlopeRows {
 public:
  /// Uses the gradients along the heading at the multiples of `step` from `low` to `high`, both included.
  /// `equilibrium` must outlive this object.
  SlopeRows(const terramech::SlopeEquilibrium& equilibrium, double low, double high, double step);

  /// Returns the smallest gradient along the heading, in multiples of the step.
  int low() const noexcept { return low_; }

  /// Returns the equilibria at the gradient `across` the heading.
  SlopeRow solved(double across) const;

 private:
  terramech::SlopeState at(double along, double across) const;
  double edge(int node, int towards, double across) const;

  const terramech::SlopeEquilibrium& equilibrium_;
  double step_;
  int low_, high_;
};

}  // namespace talus::costmap
