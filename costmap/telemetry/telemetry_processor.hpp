#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/telemetry/danger_watch.hpp>
#include <talus/costmap/telemetry/sensor_proof.hpp>
#include <talus/costmap/telemetry/sensor_watch.hpp>
#include <talus/costmap/telemetry/slip_fit.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {

/// Result of verifying the sensors of a drive, from its rows so far or from a first pass over all rows.
struct DriveVerdict {
  /// True if torque and sinkage are biased, so that they are used for the detection of danger only.
  bool without_torque = false;
  /// Verification of the sensors; null: no reading may raise an estimate.
  const SensorProof* proof = nullptr;
  /// Estimate of the slip sensor and of the ground; null: the processor uses its own estimate from the rows
  /// so far.
  std::shared_ptr<const SlipPosterior> drive{};
};

/// Returns an observation with only the bound of the ground at its place, without estimates.
WheelObservation boundAlone(const WheelObservation& observation);

/// Processes the moments of a drive in order. A moment is the rows of all wheels at one time. For each
/// moment, the sensors are checked, observations are computed, and the sensors are verified. Keeps a
/// reference to the map.
///
/// Each channel of each reading is first checked for danger separately (DangerWatch). A dangerous reading
/// bounds the ground at its place, even if the reading is rejected, and is not used to verify sensors. A
/// suspected reading has no other effect.
///
/// A moment may raise an estimate only if all wheels of the rover, or the only wheel of the file, are
/// verified. The slips of such a moment are corrected by the offset and scale of SlipFit, an excess of
/// measured slopes over the map's is subtracted, and the wheels are compared with ground of the mean strength
/// of the drive. A moment raises no estimate if the radius, width or load of a wheel differs from the
/// rover's, if the corrected slip is 0.7 or more, if a drawbar pull was measured that no other channel
/// confirms, or if torque and sinkage are biased.
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

  /// Return the verification by all rows so far. soFar() omits the estimate of the slip sensor, so that each
  /// row uses the estimate at that row.
  DriveVerdict verdict() const;
  DriveVerdict soFar() const { return {watch_.biased(), watch_.clockWentBack() ? nullptr : &proof_}; }
  const SensorWatch& watch() const noexcept { return watch_; }
  /// Returns the reason why no row may raise an estimate, and the remedy; empty if other findings contain the
  /// reason.
  std::string whyNoneRaises() const;
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
  void prove(const TelemetryRows& rows, const Sound& sound,
             const std::vector<std::optional<WheelObservation>>& seen);
  void fit(const TelemetryRows& rows, const Sound& sound);
  void refit();
  std::shared_ptr<const SlipPosterior> fitted() const;
  static bool torqueSound(const TelemetryRows& rows, std::size_t row, const DriveVerdict& verdict);
  bool mayRaise(const TelemetryRows& rows, const Moment& moment, const Sound& sound,
                const DriveVerdict& verdict) const;
  void allow(const TelemetryRows& rows, const Sound& sound, const DriveVerdict& verdict,
             std::vector<std::optional<WheelObservation>>& seen) const;
  struct SlipOfClasses;
  double slipOfClasses(const std::vector<ClassReading>& together, double gradient) const;

  const TraversabilityMap& map_;
  DangerWatch danger_;
  SensorWatch watch_;
  SensorProof proof_;
  SlipFit fit_;
  std::shared_ptr<const SlipPosterior> fitted_;  // estimate from some of the moments so far
  std::size_t next_fit_ = 0;                     // number of moments at which the fit is repeated
  WheelObserver observer_;
  std::size_t read_ = 0, transferred_ = 0, others_ = 0;
};

}  // namespace talus::costmap
