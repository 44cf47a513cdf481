#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {

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

}  // namespace talus::costmap
