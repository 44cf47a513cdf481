#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/telemetry/drive_posterior.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {

/// Slip from which a reading bounds the strength of the ground; greater than the slips of any planned drive
/// [-].
inline constexpr double kDangerSlip = 0.7;

/// Computes bounds of the strength of the ground from the reading of one wheel. Each channel of a reading is
/// checked for danger separately: neither missing, infinite or impossible values of other channels nor other
/// readings reduce the bound. A bound applies only to the ground where the reading was taken. Immutable;
/// keeps a reference to the model.
///
/// Slip: from 0.7 on, drawbar pull over load DP/W of the ground is at most that of the class, plus the slope,
/// minus the gradient at which a wheel on the class has that slip, plus 0.05 (two standard deviations). From
/// 0.8 on, the end of the cost curves, the ground is dangerous on that slope. From 0.9 on, the wheel may have
/// been stationary, and the ground is dangerous in every heading. A slip above 1 counts as 1. The slip from
/// rim speed and rover speed is used if it is greater.
///
/// Sinkage: from the policy's threshold on, sinkage over wheel radius z/r of the ground is at least the
/// measured z/r. From 0.75 on, where the entry angle leaves the range of the pull equation, the ground is
/// dangerous in every heading (ours).
///
/// Torque: from the limit of the motor on, the ground is dangerous on that slope.
///
/// If the slope along the heading is unknown, the steepest descent at the position is used.
class DangerWatch {
 public:
  explicit DangerWatch(const GroundModel& model) : model_(model) {}

  /// Returns the bound from one reading on ground of a class. `least_gradient` is the lowest possible
  /// gradient along the heading, rise over run [-].
  GroundBound bound(int class_index, const TelemetryReading& reading, double least_gradient) const;

  /// Returns the bound from a suspected reading: its DP/W, if this lies below that of the class by more than
  /// two standard deviations.
  GroundBound bound(int class_index, const WheelObservation& suspected) const;

 private:
  double dangerousBelow(double gradient) const noexcept;
  double dangerousInEveryHeading() const noexcept;

  const GroundModel& model_;
};

/// Limits of SensorWatch beyond which readings are rejected or reported.
struct SensorLimits {
  double slip_spike = 0.3;  ///< difference of the slip from the median of the last five readings [-]
  /// Difference of the torque T/(W r) from the median of the last five readings [-].
  double torque_spike = 0.3;
  /// Difference of the sinkage z/r from the median of the last five readings [-].
  double sinkage_spike = 0.25;
  std::size_t stuck_rows = 25;  ///< number of consecutive equal readings from which a sensor counts as stuck
  /// Share of rows with a changed value above which later equal values of a sensor count as stuck [-].
  double lively = 0.8;
  /// Least magnitude of the mean difference that counts as a bias: pull from torque and sinkage minus
  /// required pull, over load [-].
  double bias = 0.04;
  std::size_t bias_rows = 30;    ///< least number of rows for the detection of a bias
  double climb = 0.03;           ///< gradient above which a driven wheel cannot slip backwards [-]
  double backward_slip = -0.03;  ///< slip below which a wheel slips backwards [-]
};

/// Checks the readings of a drive, wheel by wheel, in their order. Rejects, with a reason: stuck values (of
/// all sensors of a wheel, or of one sensor that changed before), spikes, and negative slip of a driven wheel
/// on a climb. A decrease of time is counted and begins a new series. An offset of torque or sinkage appears
/// as pull that the slope does not require, on all ground; both channels are then excluded, so that only slip
/// and slope remain.
class SensorWatch {
 public:
  SensorWatch(const GroundModel& model, const SensorLimits& limits = {}) : model_(model), limits_(limits) {}

  /// Reading of a wheel, with the name of the wheel.
  struct Named {
    std::string wheel;
    TelemetryReading reading;
  };

  /// Returns for each reading of one moment the reason why it is rejected; nullopt for an accepted reading.
  /// If all wheels (two or more) jump at once, this is slip of the rover and not a spike.
  std::vector<std::optional<std::string>> refuse(const std::vector<Named>& moment);
  /// Returns the reason why the reading of one wheel is rejected; nullopt if it is accepted.
  std::optional<std::string> refuse(const std::string& wheel, const TelemetryReading& reading) {
    return refuse({{wheel, reading}}).front();
  }

  /// Adds to the statistics of bias() the pull from torque and sinkage minus the required pull of an
  /// observation.
  void compare(const WheelObservation& observation);
  /// Returns the mean of the pull from torque and sinkage minus the required pull, over load [-]; nullopt
  /// before SensorLimits::bias_rows rows.
  std::optional<double> bias() const;
  /// Returns true if |bias()| exceeds SensorLimits::bias.
  bool biased() const { return bias() && std::abs(*bias()) > limits_.bias; }

  /// Returns the results of the checks, one line each.
  std::vector<std::string> findings() const;

 private:
  // One sensor of a wheel: number of rows, number of changes of the value, and length of the present run of
  // equal values.
  struct Channel {
    std::size_t rows = 0, changes = 0, equal = 0;
  };
  struct Wheel {
    double time_s = -1e300;
    std::deque<TelemetryReading> last;
    std::size_t equal = 0;
    std::array<Channel, 3> channels{};
  };

  std::optional<std::string> judge(const Named& named);
  bool isSpike(const Wheel& wheel, const TelemetryReading& reading) const;
  bool slipsBackwardsUphill(const TelemetryReading& reading) const noexcept;
  std::optional<std::string> stuck(Wheel& wheel, const TelemetryReading& reading) const;

  const GroundModel& model_;
  SensorLimits limits_;
  std::map<std::string, Wheel> wheels_;
  std::map<std::string, std::size_t> refusals_;
  std::size_t clock_went_back_ = 0;
  double difference_sum_ = 0.0;
  std::size_t differences_ = 0;
};

/// What is known about the sensors of a drive, from its rows so far or from a first pass over all rows.
struct DriveVerdict {
  /// True if torque and sinkage are biased, so that they are used for the detection of danger only.
  bool without_torque = false;
  /// Estimate of the sensors and of the ground; null: the processor uses its own estimate from the rows so
  /// far.
  std::shared_ptr<const DriveEstimate> drive{};
  bool follows = false;  ///< true if the processor repeats its own estimate as rows arrive
};

/// Returns an observation with only the bound of the ground at its place, without estimates.
WheelObservation boundAlone(const WheelObservation& observation);

/// Processes the moments of a drive in order. A moment is the rows of all wheels at one time. For each
/// moment, the sensors are checked, observations are computed, and the posterior of the drive is updated.
/// Keeps a reference to the map.
///
/// Each channel of each reading is first checked for danger separately (DangerWatch). A dangerous reading
/// bounds the ground at its place, even if the reading is rejected. A suspected reading has no other effect.
///
/// Slips and gradients are corrected by DrivePosterior before observations are computed. Where the slip does
/// not depend on the ground, or the pose is displaced, a moment contains bounds alone. Before the first
/// estimate of the drive, and if the radius, width or load of a wheel differs from the rover's, observations
/// are of uncorrected readings and count as unverified.
class TelemetryProcessor {
 public:
  explicit TelemetryProcessor(const TraversabilityMap& map);

  /// Result for one wheel: its reading, the observation, if any, and the reason of a rejection. The
  /// observation of a rejected reading contains only a bound of the ground at its place.
  struct Result {
    TelemetryReading reading;
    std::string reason{};
    std::optional<WheelObservation> observation{};
  };

  /// Returns the results of the rows of a moment, in the order of the rows.
  std::vector<Result> process(const TelemetryRows& rows, const Moment& moment, const DriveVerdict& verdict);

  /// Returns an observation with the bound from a row that the file's reader rejected; nullopt if the row
  /// indicates no danger or has no position.
  std::optional<WheelObservation> rejected(const TelemetryRows& rows, std::size_t row) const;

  /// Return what all rows so far tell. soFar() omits the estimate of the drive, so that each row uses the
  /// estimate at that row.
  DriveVerdict verdict() const;
  DriveVerdict soFar() const { return {.without_torque = watch_.biased(), .follows = true}; }
  /// Returns what the sensors of the drive were found to be, as text, and the remedy of a fault; empty before the
  /// first estimate.
  const std::string& sensors() const noexcept { return sensors_; }
  /// Returns what the checks and the estimate of the drive found, one line each: faults of sensors, and ground that
  /// departs from its class by more than 0.05 in DP/W.
  std::vector<std::string> findings() const;
  /// Returns the number of rows whose wheel loads were computed from the load transfer on the slope.
  std::size_t transferred() const noexcept { return transferred_; }
  /// Returns the number of rows whose wheel or load differs from the rover's.
  std::size_t others() const noexcept { return others_; }

 private:
  // Accepted wheels of a moment, their rows, and whether they indicate danger.
  struct Sound {
    std::vector<ClassReading> read;
    std::vector<std::size_t> row;
    std::vector<bool> danger;
  };

  std::optional<WheelObservation> ofUnobserved(const TelemetryReading& reading, double least_gradient) const;
  GroundBound bound(const ClassReading& read, double least_gradient, bool suspected) const;
  std::vector<std::optional<WheelObservation>> observed(const Sound& sound, const DriveVerdict& verdict);
  void take(const TelemetryRows& rows, const Sound& sound);
  void follow();
  void correct(const Sound& sound, std::size_t number, const DriveVerdict& verdict,
               std::vector<std::optional<WheelObservation>>& seen) const;

  const TraversabilityMap& map_;
  DangerWatch danger_;
  SensorWatch watch_;
  DrivePosterior posterior_;
  std::shared_ptr<const DriveEstimate> fitted_;  // estimate from some of the moments so far
  std::string sensors_{};
  std::size_t next_fit_ = 0;  // number of moments at which the fit is repeated
  WheelObserver observer_;
  std::size_t transferred_ = 0, others_ = 0;
};

}  // namespace talus::costmap
