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

/// What a drive is judged by: its own rows so far, or those of a first pass.
struct DriveVerdict {
  bool without_torque = false;  ///< torque and sinkage are off: they count only where they point to danger
  const SensorProof* proof = nullptr;  ///< null: nothing may raise a belief
  /// Its slip sensor and its ground; null: as the processor knows them by the rows so far.
  std::shared_ptr<const SlipPosterior> drive{};
};

/// What is left of an observation when nothing but the bound of its place is believed.
WheelObservation boundAlone(const WheelObservation& observation);

/// Puts the moments of a drive through watch, observer and proof, one after the other. Keeps a reference to the map.
///
/// A bound is kept, an estimate is earned. Each channel of each reading is first heard for danger by itself
/// (DangerWatch): that bounds the place where it was read, whatever else is held against the reading, and proves no
/// sensor. A reading that is suspected says nothing more.
///
/// A moment may raise a belief only where each of its wheels, all of the rover's or the only one of the
/// file, is proven sound. Its slips are then read by the sensor of the drive as SlipFit has it, as far as that makes them greater, its
/// slopes relative to the map's, and the wheels are held against ground of the strength that the drive has on average. It raises
/// nothing by a wheel of another radius, width or load than the rover's, nor by one that then slips 0.7, nor by a drawbar pull that nothing else confirms, nor where torque and
/// sinkage are off.
class TelemetryProcessor {
 public:
  explicit TelemetryProcessor(const TraversabilityMap& map);

  /// Of one wheel: why it is not believed, or only as a bound of its place, and what it says if it is.
  struct Result {
    TelemetryReading reading;
    std::string reason{};
    std::optional<WheelObservation> observation{};
  };

  /// Results of the rows of a moment, in their order.
  std::vector<Result> process(const TelemetryRows& rows, const Moment& moment, const DriveVerdict& verdict);

  /// What a row that is no reading bounds; nothing where it does not, or has no place.
  std::optional<WheelObservation> rejected(const TelemetryRows& rows, std::size_t row) const;

  /// By all rows so far; soFar() leaves the slip sensor to what is known at each row.
  DriveVerdict verdict() const;
  DriveVerdict soFar() const { return {watch_.biased(), watch_.clockWentBack() ? nullptr : &proof_}; }
  const SensorWatch& watch() const noexcept { return watch_; }
  /// Where no row may raise an estimate: what keeps the drive from it, and what would mend it; empty where other findings say so.
  std::string whyNoneRaises() const;
  /// Rows whose loads were computed.
  std::size_t transferred() const noexcept { return transferred_; }
  /// Rows of another wheel than the rover's, or under another weight.
  std::size_t others() const noexcept { return others_; }

 private:
  // Wheels of a moment that nothing is held against, their rows, and whether they point to danger.
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
  std::shared_ptr<const SlipPosterior> fitted_;  // by some of the moments so far
  std::size_t next_fit_ = 0;                     // moments from which it is worked out again
  WheelObserver observer_;
  std::size_t read_ = 0, transferred_ = 0, others_ = 0;
};

}  // namespace talus::costmap
