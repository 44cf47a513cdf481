#pragma once

#include <vector>

#include "library.hpp"

namespace safety {

/// Drawbar pull over load of one wheel of a rover on one soil over slip, by drive(): exact at slips 0.05 apart
/// and at two loads, linear between (within 0.002 of the model; that is part of the allowance).
class PullCurve {
 public:
  PullCurve(const Soil& soil, const Rover& rover);

  /// DP/N [-] at a slip in [-1, 1] and a share of the load on the flat in [0.3, 1.5].
  double pull(double slip, double load_share = 1.0) const;
  /// z/r there.
  double sinkage(double slip, double load_share = 1.0) const;
  /// T/(N r) there.
  double torque(double slip, double load_share = 1.0) const;

  static constexpr double kReferenceSlip = 0.5;  ///< that categories are judged at (thesis 3.5)
  static constexpr double kMostSlip = 0.8;       ///< more counts as stuck

 private:
  struct Row {
    double pull = 0.0, sinkage = 1.0, torque = 0.0;
  };
  double read(double Row::*field, double slip, double load_share) const;

  std::vector<Row> light_, heavy_;
};

/// The class's share of doubt: what the stated deviations make of DP/W at the reference slip, to first order
/// and independent; 0.05 where none is stated (docs/limits.md).
double classDeviation(const SoilPrior& prior, const Rover& rover);

}  // namespace safety
