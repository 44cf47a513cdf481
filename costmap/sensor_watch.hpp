#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <costmap/wheel_observation.hpp>

namespace talus::costmap {

/// When readings are not believed.
struct SensorLimits {
  double slip_spike = 0.3;      ///< departure from the median of the last five
  double torque_spike = 0.3;    ///< of T/(rW), likewise
  double sinkage_spike = 0.25;  ///< of z/r, likewise
  std::size_t stuck_rows = 25;  ///< equal readings in a row that a live sensor does not give
  double bias =
      0.04;  ///< pull by torque and sinkage less pull asked for, on average, that betrays a sensor [-]
  std::size_t bias_rows = 30;  ///< rows before a bias is spoken of
};

/// Watches the readings of a drive, wheel by wheel, in the order they come. What the data can tell is refused
/// with a reason: time going backwards, stuck values, spikes. A torque offset or a sinkage datum shows as
/// pull that the slope does not ask for, on all ground alike; torque and sinkage are then left out, which
/// leaves slip against slope. A slip bias cannot be told from weak ground by one rover; it stays in the
/// doubt.
class SensorWatch {
 public:
  SensorWatch(const GroundModel& model, const SensorLimits& limits = {}) : model_(model), limits_(limits) {}

  /// Why the reading is not believed; nothing when it is.
  std::optional<std::string> refuse(const std::string& wheel, const WheelReading& reading);

  /// Counts what torque and sinkage say against what the slope asks.
  void compare(const WheelObservation& observation);
  /// Mean of that difference [-]; nothing before enough rows.
  std::optional<double> bias() const;
  /// Whether the difference is more than a sound sensor gives.
  bool biased() const { return bias() && std::abs(*bias()) > limits_.bias; }

  /// What was found, a line each.
  std::vector<std::string> findings() const;

 private:
  struct Wheel {
    double time_s = -1e300;
    std::deque<WheelReading> last;
    std::size_t equal = 0;
  };

  bool isSpike(const Wheel& wheel, const WheelReading& reading) const;

  const GroundModel& model_;
  SensorLimits limits_;
  std::map<std::string, Wheel> wheels_;
  std::map<std::string, std::size_t> refusals_;
  double difference_sum_ = 0.0;
  std::size_t differences_ = 0;
};

}  // namespace talus::costmap
