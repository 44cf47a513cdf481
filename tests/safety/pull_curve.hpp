#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "library.hpp"

namespace safety {

/// Drawbar pull over load of one wheel of a rover on one soil over slip, by drive(): exact at slips 0.05 apart
/// and at two loads, linear between (within 0.002 of the model; that is part of the allowance). At each of some slip
/// angles, with the side force.
class PullCurve {
 public:
  PullCurve(const Soil& soil, const Rover& rover);

  /// Slip angles in degrees; beyond 45 the model is not to be trusted (docs/slopes.md).
  static constexpr std::array<double, 12> kAngles_deg{0, 1, 2, 4, 6, 9, 13, 18, 24, 31, 38, 45};
  static double angle_rad(std::size_t node);

  /// DP/N [-] at a slip in [-1, 1] and a share of the load on the flat in [0.3, 1.5].
  double pull(double slip, double load_share = 1.0, std::size_t angle = 0) const;
  /// F/N there, towards the side that the wheel is turned to.
  double side(double slip, double load_share, std::size_t angle) const;
  /// z/r there.
  double sinkage(double slip, double load_share = 1.0, std::size_t angle = 0) const;
  /// T/(N r) there.
  double torque(double slip, double load_share = 1.0, std::size_t angle = 0) const;

  static constexpr double kReferenceSlip = 0.5;  ///< that categories are judged at (thesis 3.5)
  static constexpr double kMostSlip = 0.8;       ///< more counts as stuck

 private:
  struct Row {
    double pull = 0.0, sinkage = 1.0, torque = 0.0, side = 0.0;
  };
  // How a wheel is used: slip, share of the load, node of the angle.
  struct Use {
    double slip, load_share;
    std::size_t angle;
  };
  double read(double Row::*field, const Use& use) const;

  std::array<std::vector<Row>, kAngles_deg.size()> light_, heavy_;
};

/// The class's share of doubt: what the stated deviations make of DP/W at the reference slip, to first order
/// and independent; 0.05 where none is stated (docs/limits.md).
double classDeviation(const SoilPrior& prior, const Rover& rover);

}  // namespace safety
