#pragma once

#include <vector>

#include <talus/costmap/cost/slope_rows.hpp>

namespace talus::costmap {

/// Returns a value interpolated linearly between `values` at equal steps. `at` is the position in steps from
/// the first value. The result is constant beyond both ends.
double interpolated(const std::vector<double>& values, double at);

/// Straight climbs (no cross slope) under even wheel loads, for finding the climb with the same cost as a
/// slope with a gradient across the heading.
class LevelClimbs {
 public:
  /// Takes the climbs from row 0 (no gradient across); climbs steeper than `last` are reduced to `last`.
  LevelClimbs(const SlopeRow& level, double last);

  /// For each equilibrium of a row: `climb` is the additional gradient of the straight climb with the same
  /// energy and time (>= 0), and `slip` is the additional slip of the equilibrium relative to that climb.
  struct Surcharges {
    std::vector<double> climb, slip;
  };
  Surcharges surcharges(const SlopeRow& row) const;

 private:
  double reached(const std::vector<double>& values, double value) const;

  double last_, step_;
  int first_node_;
  std::vector<double> energies_, times_, slips_;
};

/// Strength of ground without cross slope: gradient `last` of the steepest climb without failure, and gross
/// `thrust` over load at the reference slip [-].
struct LevelStrength {
  double last, thrust;
};

/// Returns the loss of drawbar pull over load at which driving on a slope with the gradients `along` and
/// `across` the heading fails; <= 0 if it fails without a loss. A loss of pull adds to the climb, and the
/// corresponding loss of side force increases the effective gradient across. `losses[k]` is the reduction of
/// the steepest climb at the gradient across k/64.
double strengthToLose(double along, double across, const LevelStrength& level,
                      const std::vector<double>& losses);

}  // namespace talus::costmap
