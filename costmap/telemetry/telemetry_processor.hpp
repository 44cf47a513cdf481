#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/telemetry/danger_watch.hpp>
#include <talus/costmap/telemetry/drive_posterior.hpp>
#include <talus/costmap/telemetry/sensor_watch.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {

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
