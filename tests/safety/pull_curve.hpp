#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "library.hpp"

namespace safety {

/// Drawbar pull over load of one wheel of a rover on one soil as a function of slip, computed by drive().
/// Exact at slips 0.05 apart and at two loads, linear between (error at most 0.002, part of the allowance).
/// Tabulated with the side force at each of several slip angles.
class PullCurve {
 public:
  PullCurve(const Soil& soil, const Rover& rover);

  /// Slip angles in degrees; the model is not valid beyond 45 (docs/slopes.md).
  static constexpr std::array<double, 12> kAngles_deg{0, 1, 2, 4, 6, 9, 13, 18, 24, 31, 38, 45};
  static double angle_rad(std::size_t node);

  /// Drawbar pull over load DP/N [-] at a slip in [-1, 1] and a load in [0.3, 1.5] of the load on level
  /// ground.
  double pull(double slip, double load_share = 1.0, std::size_t angle = 0) const;
  /// Side force over load F/N [-], positive towards the side to which the wheel is turned.
  double side(double slip, double load_share, std::size_t angle) const;
  /// Sinkage over radius z/r [-].
  double sinkage(double slip, double load_share = 1.0, std::size_t angle = 0) const;
  /// Torque over load and radius T/(N r) [-].
  double torque(double slip, double load_share = 1.0, std::size_t angle = 0) const;

  static constexpr double kReferenceSlip = 0.5;  ///< slip at which categories are judged (thesis 3.5)
  static constexpr double kMostSlip = 0.8;       ///< a higher slip counts as immobilised

 private:
  struct Row {
    double pull = 0.0, sinkage = 1.0, torque = 0.0, side = 0.0;
  };
  // State of a wheel: slip, load share, node of the angle.
  struct Use {
    double slip, load_share;
    std::size_t angle;
  };
  double read(double Row::*field, const Use& use) const;

  std::array<std::vector<Row>, kAngles_deg.size()> light_, heavy_;
};

/// Standard deviation of the class's DP/W at the reference slip, propagated to first order from the stated,
/// independent standard deviations of the soil; 0.05 if none is stated (docs/limits.md).
double classDeviation(const SoilPrior& prior, const Rover& rover);

}  // namespace safety
