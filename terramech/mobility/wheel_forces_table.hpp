#pragma once

#include <array>
#include <functional>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// What the soil does to a wheel, over its load or radius [-].
enum WheelChannel {
  kPullRatio,
  kSideRatio,
  kTorqueRatio,
  kSinkageRatio,
  kWheelChannels
};  // DP/N, F/N, T/(rN), z/r

/// The channels at a point, and how they change there with slip and with slip angle.
struct WheelRatios {
  std::array<double, kWheelChannels> value{}, by_slip{}, by_angle{};
};

/// How a wheel is used, as WheelOperation.
struct WheelMotion {
  double load_N = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;
};

/// One wheel of a rover on one ground, tabulated over slip, slip angle and load: cubic in all three, so that
/// the slope equilibrium of a rover solves no contact. Side force is odd in the slip angle, the rest even.
/// Off the exact wheel by less than 0.015 in each channel, 0.001 in the median (WheelForcesTable.IsTheWheel).
/// Immutable; thread-safe.
class WheelForcesTable {
 public:
  static constexpr int kSlips = 41, kAngles = 16, kLoads = 5;
  static constexpr double kSlipStep = 0.05, kAngleStep_rad = 0.0698131700797732;  // 4 deg, to 60 deg

  /// Under loads about the even share of the rover's weight; throws std::invalid_argument as wong_reece.hpp.
  WheelForcesTable(const Soil& soil, const Rover& rover);

  /// The same of a model with effects but those of its sensors, at the rover's speed, on fresh ground; 20
  /// times slower.
  WheelForcesTable(const RefinedModel& model, const Rover& rover);

  /// Slip within [-1, 1], slip angle within 60 deg; loads beyond the table count as its ends.
  WheelRatios at(const WheelMotion& motion) const noexcept;

  /// Node of the table under the even load: slips from -1 up, angles from 0 up.
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
