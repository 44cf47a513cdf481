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

/// When readings are not believed.
struct SensorLimits {
  double slip_spike = 0.3;      ///< departure from the median of the last five
  double torque_spike = 0.3;    ///< of T/(rW), likewise
  double sinkage_spike = 0.25;  ///< of z/r, likewise
  std::size_t stuck_rows = 25;  ///< equal readings in a row that a live sensor does not give
  double lively = 0.8;          ///< share of rows in which a value changed that is not rounded to few steps
  double slip_excess = 0.05;  ///< mean slip beyond what the soil asks for on these slopes that is spoken of,
                              ///< where it is also more than its scatter
  /// Pull by torque and sinkage less pull asked for, on average, that betrays a sensor [-].
  double bias = 0.04;
  std::size_t bias_rows = 30;    ///< rows before a bias is spoken of
  double climb = 0.03;           ///< gradient from which a driven wheel cannot slip backwards [-]
  double backward_slip = -0.03;  ///< slip below which it would
  double gap = 10.0;             ///< intervals without a row that make a gap in time
};

/// Watches the readings of a drive, wheel by wheel, in the order they come. What the data can tell is refused
/// with a reason: time going backwards, stuck values (of a wheel or of one of its sensors that was lively
/// before), spikes. A torque offset or a sinkage datum shows as
/// pull that the slope does not ask for, on all ground alike; torque and sinkage are then left out, which
/// leaves slip against slope. Odometry that has a driven wheel slip backwards on a climb is refused; any
/// other slip bias cannot be told from ground that is weaker or firmer than believed by one rover: what all
/// ground shares is reported as either. Gaps in time and values that are missing now and then are counted.
class SensorWatch {
 public:
  SensorWatch(const GroundModel& model, const SensorLimits& limits = {}) : model_(model), limits_(limits) {}

  /// A wheel's name and what it read.
  struct Named {
    std::string wheel;
    TelemetryReading reading;
  };

  /// Why each of the readings of one moment is not believed; nothing where it is. What jumps at all wheels of
  /// several at once is the rover, slipping, and no spike.
  std::vector<std::optional<std::string>> refuse(const std::vector<Named>& moment);
  /// The same of one wheel.
  std::optional<std::string> refuse(const std::string& wheel, const TelemetryReading& reading) {
    return refuse({{wheel, reading}}).front();
  }

  /// Counts what torque and sinkage say against what the slope asks.
  void compare(const WheelObservation& observation);
  /// Counts by how much a wheel slips more than its soil asks for on the slope.
  void compareSlip(double excess);
  /// Mean of that difference [-]; nothing before enough rows.
  std::optional<double> bias() const;
  /// Whether the difference is more than a sound sensor gives.
  bool biased() const { return bias() && std::abs(*bias()) > limits_.bias; }

  /// Mean slip beyond what the soil asks for, where all ground shares it [-]; nothing where it is little, or
  /// less than its scatter.
  std::optional<double> slipExcess() const;

  /// Whether the time of some wheel's rows decreased.
  bool clockWentBack() const noexcept { return clock_went_back_ > 0; }

  /// What was found, a line each.
  std::vector<std::string> findings() const;

 private:
  // One sensor of a wheel: how lively it was and how long it has stood still.
  struct Channel {
    std::size_t rows = 0, changes = 0, equal = 0;
  };
  struct Wheel {
    double time_s = -1e300;
    double interval_s = 0.0;  // between rows, the mean outside gaps
    std::size_t intervals = 0;
    bool has_torque = false, has_sinkage = false;
    std::deque<TelemetryReading> last;
    std::size_t equal = 0;
    std::array<Channel, 3> channels{};
  };

  std::optional<std::string> judge(const Named& named);
  bool isSpike(const Wheel& wheel, const TelemetryReading& reading) const;
  bool slipsBackwardsUphill(const TelemetryReading& reading) const noexcept;
  std::optional<std::string> stuck(Wheel& wheel, const TelemetryReading& reading) const;
  void countGap(Wheel& wheel, double time_s);
  void countDropout(Wheel& wheel, const TelemetryReading& reading);

  const GroundModel& model_;
  SensorLimits limits_;
  std::map<std::string, Wheel> wheels_;
  std::map<std::string, std::size_t> refusals_;
  std::size_t gaps_ = 0, dropouts_ = 0, clock_went_back_ = 0;
  double longest_gap_s_ = 0.0;
  double difference_sum_ = 0.0;
  std::size_t differences_ = 0;
  double excess_sum_ = 0.0, excess_squares_ = 0.0;
  std::size_t excesses_ = 0;
};

}  // namespace talus::costmap
