#pragma once

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

 private:
  double dangerousBelow(double gradient) const noexcept;
  double dangerousInEveryHeading() const noexcept;

  const GroundModel& model_;
};

/// What is known about the sensors of a drive, from its rows so far or from a first pass over all rows.
struct DriveVerdict {
  /// Estimate of the sensors and of the ground; null: the processor uses its own estimate from the rows so
  /// far.
  std::shared_ptr<const DriveEstimate> drive{};
  bool follows = false;  ///< true if the processor repeats its own estimate as rows arrive
};

/// Returns an observation with only the bound of the ground at its place, without estimates.
WheelObservation boundAlone(const WheelObservation& observation);

/// Processes the moments of a drive in order. A moment is the rows of all wheels at one time. For each
/// moment, observations are computed and the posterior of the drive is updated.
/// Keeps a reference to the map.
///
/// Each channel of each reading is first checked for danger separately (DangerWatch). A dangerous reading
/// bounds the ground at its place, even if the reading is rejected. If the slip of some wheels alone departs by more
/// than 0.3 from the median of their last five, it bounds the ground under these wheels and tells nothing of other
/// ground: they are on the edge of another soil.
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

  /// Returns what all rows so far tell.
  DriveVerdict verdict() const;
  /// Returns what the sensors of the drive were found to be, as text, and the remedy of a fault; empty before the
  /// first estimate.
  const std::string& sensors() const noexcept { return sensors_; }
  /// Returns what the estimate of the drive found, one line each: faults of sensors, and ground that
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
    std::vector<double> second;  // second slips
  };

  std::vector<bool> jumps(const TelemetryRows& rows, const Moment& moment);
  std::optional<WheelObservation> ofUnobserved(const TelemetryReading& reading, double least_gradient) const;
  void take(const TelemetryRows& rows, const Sound& sound);
  void follow();
  void correct(const Sound& sound, std::size_t number,
               std::vector<std::optional<WheelObservation>>& seen) const;

  const TraversabilityMap& map_;
  DangerWatch danger_;
  DrivePosterior posterior_;
  std::shared_ptr<const DriveEstimate> fitted_;  // estimate from some of the moments so far
  std::string sensors_{};
  const char* settles_ = "";  // remedy of a fault of the slip
  std::size_t next_fit_ = 0;  // number of moments at which the fit is repeated
  WheelObserver observer_;
  std::size_t transferred_ = 0, others_ = 0;
  std::map<std::string, std::deque<double>> slips_{};  // last slips of each wheel
};

}  // namespace talus::costmap
