#pragma once

#include <array>
#include <functional>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Forces on a wheel divided by its load, and sinkage divided by its radius [-].
enum WheelChannel {
  kPullRatio,
  kSideRatio,
  kTorqueRatio,
  kSinkageRatio,
  kWheelChannels
};  // DP/N, F/N, T/(rN), z/r

/// Values of the channels at a point, and their derivatives by slip and by slip angle [1/rad].
struct WheelRatios {
  std::array<double, kWheelChannels> value{}, by_slip{}, by_angle{};
};

/// Load, slip and slip angle of a wheel, as WheelOperation.
struct WheelMotion {
  double load_N = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;
};

/// Forces of one wheel of a rover on one ground, tabulated over slip, slip angle and load, so that a slope
/// equilibrium needs no contact solution. Interpolation: cubic in slip and slip angle, degree 4 in the
/// logarithm of the load. Side force is odd in the slip angle, the other channels even. Error below 0.015 in
/// each channel, median 0.001 (WheelForcesTable.MatchesTheWheel). Immutable; thread-safe.
class WheelForcesTable {
 public:
  static constexpr int kSlips = 41, kAngles = 16, kLoads = 5;
  static constexpr double kSlipStep = 0.05, kAngleStep_rad = 0.0698131700797732;  // 4 deg, to 60 deg

  /// Tabulates loads around the even share of the rover's weight. Throws std::invalid_argument as
  /// wong_reece.hpp.
  WheelForcesTable(const Soil& soil, const Rover& rover);

  /// Tabulates a model with effects, without sensor errors, at the rover's speed and pass 1; 20 times slower.
  /// Throws std::invalid_argument also for the base linear-formula.
  WheelForcesTable(const RefinedModel& model, const Rover& rover);

  /// Returns the interpolated channels; slip, slip angle and load are clamped to the table, [-1, 1], 60 deg
  /// and 0.2 to 4.8 of the even load.
  WheelRatios at(const WheelMotion& motion) const noexcept;

  /// Returns the tabulated value under the even load. `slip` and `angle` are node indices from 0, of the slip
  /// slipOf(slip) and the slip angle angleOf(angle) [rad].
  double atNode(WheelChannel channel, int slip, int angle) const {
    return even_[static_cast<std::size_t>((angle * kSlips + slip) * kWheelChannels + channel)];
  }
  static double slipOf(int node) { return -1.0 + kSlipStep * node; }
  static double angleOf(int node) { return kAngleStep_rad * node; }

 private:
  using Node = std::array<double, kWheelChannels>;
  using Solve = std::function<Node(const WheelMotion&)>;
  void tabulate(const std::vector<Node>& nodes);
  static std::vector<WheelMotion> motions(double even_load_N);

  double even_load_N_;
  std::vector<double> nodes_;  // [load][angle, one before 0][slip][channel]
  std::vector<double> even_;   // [angle][slip][channel]
};

}  // namespace talus::terramech
