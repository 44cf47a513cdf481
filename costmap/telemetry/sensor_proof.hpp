#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/telemetry/response.hpp>
#include <talus/costmap/telemetry/step_watch.hpp>

namespace talus::costmap {

/// Whether the sensors of a drive have shown, against each other, that they are sound, so that what they say may
/// raise a belief. Each proof needs something that a sensor which is stuck, biased, displaced or silent does not
/// give; without it there is none (all limits ours):
///
/// slip        rises with the slope that is climbed; on level ground it may be low, by a bias or by firm ground, and
///             counts as if it were by a bias; where it steps on the way, either side may be the wrong one
/// slope       as the rover measured it follows the map's where the rover says it is, is not off it, and is not
///             steeper: the scale of its regression on the map's lies above 1.15 by no more than two standard errors
/// torque,     taken together as pull, follow the slope and are not off it
/// sinkage
/// pose        moves from row to row by no more than it did before; after a jump nothing is proven until it is
///             back, since either side of the jump may be the wrong one
class SensorProof {
 public:
  /// What one wheel read, and what is known about its place. NaN = not known.
  struct Row {
    std::string run, wheel;
    TelemetryReading reading;
    double measured_gradient = 0.0;  ///< along the heading, by the rover
    double map_gradient = 0.0;       ///< the same by the map
    double class_slip = 0.0;         ///< of ground of the class on the measured gradient
    double torque_pull = 0.0;        ///< drawbar pull over load by torque and sinkage
    double share = 0.0;              ///< of its class's thrust at the reference slip, at its slip
    bool danger = false;             ///< it points to danger: it proves nothing but where the rover is
  };

  /// By how much it may step on the way [-].
  static constexpr double kLevelStep = 0.04;
  void take(const Row& row);

  /// Whether the pull that the wheel read may raise a belief: by all rows so far.
  bool pullSound(const std::string& run, const std::string& wheel) const {
    return lack(run, wheel) == Lack::Nothing;
  }
  /// What keeps it from that, the first of them.
  enum class Lack : std::uint8_t {
    Nothing,
    Pose,
    SlopeRows,
    Slopes,
    Slope,
    SlopeBias,
    SlopeScale,
    Slip,
    LevelRows,
    SlipStep
  };
  Lack lack(const std::string& run, const std::string& wheel) const;
  /// Of any wheel.
  Lack lack() const;
  /// In words, with what would mend it.
  static const char* text(Lack lack) noexcept;
  /// Whether torque and sinkage are proven too.
  bool torqueSound(const std::string& run, const std::string& wheel) const;
  /// Whether the last rows contradict what the rows before proved.
  bool doubted(const std::string& run, const std::string& wheel) const;
  /// Whether the pose, after the rows so far, is off by a jump.
  bool displaced(const std::string& run) const;
  /// Whether it drove at slips at which most of the thrust of its class is felt, so that what it read at little slip was
  /// not all that it read.
  bool felt(const std::string& run, const std::string& wheel) const;
  /// By how much the rover measures slopes that are steeper than the map's, on average.
  double gradientExcess(const std::string& run) const;
  /// Wheels that read anything.
  std::size_t wheels(const std::string& run) const;

 private:
  struct Wheel {
    std::optional<TelemetryReading> last, last_counted;
    ResponseSeries slip, torque;
    std::size_t level_rows = 0, felt_rows = 0;
  };
  struct Run {
    ResponseSeries slope;
    double fastest_mps = 0.0;
    maps::Point off{0.0, 0.0};  // sum of the jumps
    std::map<std::string, Wheel> wheels;
  };

  bool slopeScaled(const Run& run) const noexcept;
  static void follow(Run& run, const Wheel& wheel, const TelemetryReading& reading);
  void takeLevel(Wheel& wheel, const Row& row);
  const Run* find(const std::string& run) const;
  static const Wheel* find(const Run& run, const std::string& wheel);

  std::map<std::string, Run> runs_;
  Response slopes_;                               // of all runs: the slope sensor is one
  std::map<std::string, StepWatch> level_steps_;  // of each wheel, of all runs: its sensor is one
};

}  // namespace talus::costmap
