#pragma once

#include <utility>
#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

/// Equilibria of one gradient across, on a lattice of gradients along.
struct SlopeRow {
  double step = 1.0;  ///< of the lattice
  double first = 0.0,
         last = -1.0;  ///< gradients that the ground holds; infinite where they lie beyond the lattice
  bool tips_before = false, tips_behind = false;  ///< ends so near to tipping that loads end it, not strength
  int first_node = 0;                             ///< the first of `states`, in steps
  std::vector<terramech::SlopeState> states{};    ///< the longest range that the ground holds, tipping apart
  std::vector<terramech::SlopeState> all{};       ///< of the whole lattice
  std::vector<std::pair<double, double>>
      margins_rad{};  ///< against tipping, by gradient along, over that range

  /// Whether it lies within the range that the ground holds.
  bool holds(double along) const noexcept { return along >= first && along <= last; }

  /// Linear between equilibria; NaN where the ground holds nothing, or the rover's height is not known.
  double margin_rad(double along) const;
};

/// Solves rows on a lattice of gradients along, of a rover whose left and right differ on the slope to the worse side.
class SlopeRows {
 public:
  /// From low to high, both included, at multiples of the step. The equilibrium must outlive it.
  SlopeRows(const terramech::SlopeEquilibrium& equilibrium, double low, double high, double step);

  /// The lattice's first gradient, in steps.
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
