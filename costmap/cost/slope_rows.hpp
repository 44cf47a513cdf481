#pragma once

#include <utility>
#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

/// Slope equilibria for one gradient across the heading, at equally spaced gradients along the heading.
struct SlopeRow {
  double step = 1.0;  ///< step of the gradients along
  double first = 0.0,
         last = -1.0;  ///< interval of gradients without failure; infinite beyond the tabulated gradients
  bool tips_before = false, tips_behind = false;  ///< true if tipping limits `first`, `last`
  int first_node = 0;                             ///< gradient of states[0], in steps
  std::vector<terramech::SlopeState> states{};    ///< states in the interval, tipping ones included
  std::vector<terramech::SlopeState> all{};       ///< states at all tabulated gradients
  std::vector<std::pair<double, double>>
      margins_rad{};  ///< stability margin by gradient along, over the interval of `states`

  /// True if a gradient lies within the interval without failure.
  bool holds(double along) const noexcept { return along >= first && along <= last; }

  /// Stability margin [rad] by linear interpolation; NaN without states, or if the height of the centre of
  /// mass is unknown.
  double margin_rad(double along) const;
};

/// Solves the slope equilibria of a gradient across for all tabulated gradients along. For a rover whose left
/// and right sides differ, each state is that of the less favourable side: the side that fails, else the side
/// with the higher energy.
class SlopeRows {
 public:
  /// Gradients along at the multiples of `step` from low to high, both included. The equilibrium must outlive
  /// this object.
  SlopeRows(const terramech::SlopeEquilibrium& equilibrium, double low, double high, double step);

  /// Returns the smallest gradient along, in steps.
  int low() const noexcept { return low_; }

  SlopeRow solved(double across) const;

 private:
  terramech::SlopeState at(double along, double across) const;
  double edge(int node, int towards, double across) const;

  const terramech::SlopeEquilibrium& equilibrium_;
  double step_;
  int low_, high_;
};

}  // namespace talus::costmap
