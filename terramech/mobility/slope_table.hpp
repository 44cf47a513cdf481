#pragma once

#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::terramech {

/// How finely a ground is tabulated.
struct SlopeTableOptions {
  SlopeOptions slope;
  double step = 0.03;          ///< between nodes, rise over run, (0, 0.5]
  double max_gradient = 0.75;  ///< in each of the two directions, (0, 2]; beyond it nothing is said to hold
};

/// The equilibria of one ground and rover over gradients along and across: what a cost reads. What lies
/// between nodes is taken from the four about it, and holds only where they all hold: never where the exact
/// equilibrium fails at one of them, so it gives up less than one step of gradient and, but for an island
/// smaller than a cell, allows nothing that fails. Numbers are interpolated; the reason is that of the first
/// corner that fails. Immutable; thread-safe.
class SlopeTable {
 public:
  /// Throws std::invalid_argument as SlopeEquilibrium, and when an option leaves its range.
  explicit SlopeTable(const SlopeEquilibrium& equilibrium, const SlopeTableOptions& options = {});

  SlopeState at(const Gradient& gradient) const noexcept;

  double step() const { return options_.step; }
  std::size_t nodes() const { return states_.size(); }

 private:
  const SlopeState& node(int along, int across) const {
    return states_[static_cast<std::size_t>((along + reach_) * columns_ + across + (mirrored_ ? 0 : reach_))];
  }
  SlopeState between(double along, double across) const noexcept;

  SlopeTableOptions options_;
  bool mirrored_;  // left and right alike: only gradients that rise to the left are kept
  int reach_, columns_;
  std::vector<SlopeState> states_;
};

}  // namespace talus::terramech
