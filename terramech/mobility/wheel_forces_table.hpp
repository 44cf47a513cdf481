#pragma once

#include <array>
#include <functional>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Index of a tabulated quantity of a wheel [-]: drawbar pull over load DP/N, side force over load F/N,
/// torque ratio T/(rN), and sinkage over radius z/r. kWheelChannels is the number of quantities.
enum WheelChannel {
  kPullRatio,
  kSideRatio,
  kTorqueRatio,
  kSinkageRatio,
  kWheelChannels
};  // DP/N, F/N, T/(rN), z/r

/// Tabulated quantities at one slip, slip angle and load, with their derivatives with respect to slip [-] and
/// to slip angle [1/rad].
struct WheelRatios {
  std::array<double, kWheelChannels> value{}, by_slip{}, by_angle{};
};

/// Load N, slip and slip angle of a wheel, with the definitions of WheelOperation in wong_reece.hpp.
struct WheelMotion {
  double load_N = 0.0;          ///< load normal to the ground, > 0
  double slip = 0.0;            ///< slip along the wheel plane, [-1, 1]
  double slip_angle_rad = 0.0;  ///< from the wheel plane to the direction of travel, positive to the left
};

/// Table of the forces on one wheel of a rover on one kind of ground, over slip, slip angle and load. With
/// this table a SlopeEquilibrium needs no solution of the wheel-soil contact. The interpolation is cubic in
/// slip and slip angle, and a polynomial of degree 4 in the logarithm of the load. The side force is odd in
/// the slip angle, the other quantities are even. The error of each quantity is below 0.015, with median
/// 0.001 (WheelForcesTable.MatchesTheWheel). The even load is the rover's weight divided by its number of
/// wheels. Immutable; thread-safe.
class WheelForcesTable {
 public:
  /// Number of tabulated slips, slip angles and loads, and spacing of slips and slip angles.
  static constexpr int kSlips = 41, kAngles = 16, kLoads = 5;
  static constexpr double kSlipStep = 0.05, kAngleStep_rad = 0.0698131700797732;  // 4 deg, to 60 deg

  /// Tabulates the forces on a soil, for loads of 0.2 to 4.8 even loads. Throws the std::invalid_argument
  /// exceptions of wong_reece.hpp.
  WheelForcesTable(const Soil& soil, const Rover& rover);

  /// Tabulates a wheel model with effects, without sensor errors, at the rover's maximum speed and a
  /// pass >= 1; this takes 20 times as long. Throws std::invalid_argument also for the base model linear-formula.
  WheelForcesTable(const RefinedModel& model, const Rover& rover, int pass = 1);

  /// Returns the interpolated quantities. Slip is clamped to [-1, 1], the slip angle to +-60 deg, and the
  /// load to 0.2 to 4.8 even loads.
  WheelRatios at(const WheelMotion& motion) const noexcept;

  /// Returns a tabulated quantity under the even load. `slip` and `angle` are node indices from 0: the node
  /// has the slip slipOf(slip) and the slip angle angleOf(angle) [rad].
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
