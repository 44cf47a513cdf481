#pragma once

#include <vector>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::terramech {

/// Options of a SlopeTable.
struct SlopeTableOptions {
  SlopeOptions slope;  ///< limits of slip and slip angle
  double step = 0.03;  ///< spacing of the tabulated gradients (rise over run), [1e-3, 0.5]
  /// Largest tabulated gradient, along and across, [step, 2]; steeper planes fail.
  double max_gradient = 0.75;
};

/// Table of the steady motion of one rover on one kind of ground, for cost functions. The table is a grid
/// over the two gradients (rise over run) of an inclined plane: along and across the direction of travel.
/// Each node of the grid contains the state that SlopeEquilibrium computes there. Between nodes, the rover
/// has a steady motion only if a steady motion exists at all nodes with a non-zero interpolation weight. The
/// table therefore rejects feasible gradients that are less than one step from the limit of feasibility, and
/// accepts an infeasible gradient only between four feasible nodes. Numbers are interpolated linearly; the
/// failure is that of one failing node. SlopeState::grip is not tabulated. Immutable; thread-safe.
class SlopeTable {
 public:
  /// Computes all nodes. Throws std::invalid_argument if an option is outside its range.
  explicit SlopeTable(const SlopeEquilibrium& equilibrium, const SlopeTableOptions& options = {});

  /// Returns the state at a gradient. Beyond max_gradient the failure is CannotPull uphill, otherwise Slides.
  SlopeState at(const Gradient& gradient) const noexcept;

  /// Returns the spacing of the nodes in gradient [-].
  double step() const { return options_.step; }
  /// Returns the number of nodes.
  std::size_t nodes() const { return states_.size(); }

 private:
  const SlopeState& node(int along, int across) const {
    return states_[static_cast<std::size_t>((along + reach_) * columns_ + across + (mirrored_ ? 0 : reach_))];
  }
  SlopeState between(double along, double across) const noexcept;

  SlopeTableOptions options_;
  bool mirrored_;  // the rover is symmetric: only gradients rising to the left are stored
  int reach_, columns_;
  std::vector<SlopeState> states_;
};

}  // namespace talus::terramech
