#pragma once

#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::terramech {

/// Options of a SlopeTable.
struct SlopeTableOptions {
  SlopeOptions slope;
  double step = 0.03;          ///< node spacing, rise over run, [1e-3, 0.5]
  double max_gradient = 0.75;  ///< in both directions, [step, 2]; steeper gradients fail
};

/// Equilibria of one ground and rover, tabulated over the gradients along and across, for cost functions. A
/// state between nodes is an equilibrium only if all four surrounding nodes are. The table therefore rejects
/// feasible gradients within less than one step of the limit, and accepts an infeasible gradient only between
/// four feasible nodes. Numbers are interpolated; the failure is that of the first failing corner; `grip` is
/// not tabulated. Immutable; thread-safe.
class SlopeTable {
 public:
  /// Throws std::invalid_argument if an option is outside its range.
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
  bool mirrored_;  // symmetric rover: only gradients rising to the left are stored
  int reach_, columns_;
  std::vector<SlopeState> states_;
};

}  // namespace talus::terramech
