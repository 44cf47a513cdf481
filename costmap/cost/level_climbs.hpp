#pragma once

#include <vector>

#include <talus/costmap/cost/slope_rows.hpp>

namespace talus::costmap {

/// Linear interpolation of values at equal steps; `at` is in steps from the first value. Constant beyond the
/// ends.
double interpolated(const std::vector<double>& values, double at);

/// Straight climbs under even loads, for finding the climb with the same cost as a two-dimensional slope.
class LevelClimbs {
 public:
  /// Uses row 0 (no gradient across); climbs beyond `last` are reduced to `last`.
  LevelClimbs(const SlopeRow& level, double last);

  /// For each state of a row: additional gradient of the straight climb with the same energy and time (>= 0),
  /// and additional slip of the state relative to that climb.
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

/// Gradient of the steepest climb without failure, and gross thrust divided by load at the reference slip
/// [-].
struct LevelStrength {
  double last, thrust;
};

/// Returns the loss of drawbar pull over load at which a slope fails; <= 0 if the slope fails without a loss.
/// A loss of pull adds to the climb, and a loss of side force increases the effective gradient across.
/// `losses[k]` is the reduction of the steepest climb at the gradient across k/64.
double strengthToLose(double along, double across, const LevelStrength& level,
                      const std::vector<double>& losses);

}  // namespace talus::costmap
