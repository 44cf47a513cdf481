#pragma once

#include <optional>

#include <costmap/ground_model.hpp>
#include <maps/grid.hpp>

namespace talus::costmap {

/// What one wheel read at one moment, corrected for nothing. NaN = not measured.
struct WheelReading {
  double time_s = 0.0;
  maps::Point place;       ///< of the wheel on the map
  double load_N = 0.0;     ///< on the wheel, > 0
  double slip = 0.0;       ///< [-1, 1]
  double torque_Nm = 0.0;  ///< on the wheel
  double sinkage_m = 0.0;
  double gradient = 0.0;        ///< of the ground along the heading, rise over run
  double drawbar_pull_N = 0.0;  ///< where a test stand measures it
  int pass = 1;                 ///< how often this ground was driven, this pass included
};

/// How well the readings are known, one standard deviation.
struct ReadingNoise {
  double slip = 0.03;
  double gradient = 0.01;
  double torque_share = 0.05;   ///< of T/(rW)
  double sinkage_share = 0.05;  ///< of the wheel radius, times z/r's slope
  double model_pull =
      0.02;  ///< of thesis Eq. 3.12 as a model of DP/W, and of a wheel pulling its own share [-]
};

/// What a reading says about the ground under the wheel, at the reference slip.
struct WheelObservation {
  double time_s = 0.0;
  maps::Point place;
  Estimate pull;             ///< drawbar pull over load [-]
  Estimate sinkage;          ///< sinkage over radius [-]; std is infinite where nothing was measured
  double demand = 0.0;       ///< drawbar pull over load that the slope asked for [-]
  double from_torque = 0.0;  ///< drawbar pull over load by torque and sinkage [-]; NaN without them
};

/// Turns readings into observations for one class of ground.
///
/// A steady rover's wheels together pull what the slope asks, DP/N = tan(slope); torque and sinkage say what
/// this one pulls (thesis Eq. 3.12). Both hold at the slip it drives at. The class's own mobility curve says
/// at which gradient its ground gives that slip; the difference is the ground's departure from its class, the
/// shift of GroundModel.
class WheelObserver {
 public:
  explicit WheelObserver(const GroundModel& model, const ReadingNoise& noise = {});

  /// What the reading says about ground of the class; nothing where it cannot be used (no slip, no load, or
  /// neither slope, torque nor drawbar pull).
  std::optional<WheelObservation> observe(int class_index, const WheelReading& reading) const;

 private:
  const GroundModel& model_;
  ReadingNoise noise_;
};

/// Drawbar pull over load of a wheel by torque and sinkage: DP/W = -tan(theta_1/2) +
/// [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW), theta_1 = arccos(1 - z/r) (kang_2003 Eq. 3.12,
/// corrected).
double pullFromTorque(double torque_over_load_radius, double sinkage_over_radius) noexcept;

}  // namespace talus::costmap
