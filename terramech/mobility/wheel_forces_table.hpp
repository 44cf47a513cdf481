#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Returns the state of a wheel of a rover in steady motion. For a slip s >= 0 the rim speed is the rover's
/// maximum speed v and the travel speed is v (1 - s). For s < 0 (braking) the rim speed is v (1 + s) and the
/// travel speed is v. Pass number and slope of the state are unknown.
inline WheelState steadyWheel(const Rover& rover, double load_N, double slip, double slip_angle_rad = 0.0) {
  WheelState state;
  state.wheel = rover.wheel;
  state.load_N = load_N;
  state.slip = slip;
  state.slip_angle_rad = slip_angle_rad;
  state.rim_speed_mps = rover.max_speed_mps * (1.0 + std::min(slip, 0.0));
  state.speed_mps = rover.max_speed_mps * (1.0 - std::max(slip, 0.0));
  state.gravity_m_s2 = rover.gravity_m_s2;
  return state;
}

/// Returns the Wong-Reece model on a soil, without effects.
RefinedModel onSoil(const Soil& soil);

/// Throws std::invalid_argument if the soil of a model is out of range, or for the base model linear-formula.
void requireForces(const RefinedModel& model);

/// Returns the soil in the rut of an equal wheel: k_c and k_phi times Soil::rut_stiffness r, K over sqrt(r). When a plate
/// reloads soil, the soil is some tens of times stiffer (wong_2001, response to repetitive loading), but a slipping
/// wheel continues to dig: with r = 4 the resistance of a second wheel is about half that of the first, because
/// resistance increases with the square root of the sinkage. Compacted soil has a smaller K (in senatore_sandu_2011 K
/// falls with density). Cohesion and friction angle are unchanged (ours: their increase is neglected).
Soil rutted(const Soil& soil);
/// Returns the model in the rut of an equal wheel: unchanged if it has a multipass effect, which then describes
/// the second pass; otherwise on the soil in the rut.
RefinedModel rutted(const RefinedModel& model);

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

/// Load N, slip and slip angle of a wheel, with the definitions of WheelOperation in wheel_on_soil.hpp.
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

  /// Tabulates the forces of a wheel model without its sensor errors, for loads of 0.2 to 4.8 even loads, at the
  /// rover's maximum speed and a pass >= 1; with effects this takes 20 times as long. Throws the
  /// std::invalid_argument exceptions of wheel_on_soil.hpp and requireForces().
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
  void tabulate(const std::vector<Node>& nodes);
  static std::vector<WheelMotion> motions(double even_load_N);

  double even_load_N_;
  std::vector<double> nodes_;  // [load][angle, one before 0][slip][channel]
  std::vector<double> even_;   // [angle][slip][channel]
};

}  // namespace talus::terramech
