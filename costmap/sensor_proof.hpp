#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <talus/costmap/wheel_observation.hpp>

namespace talus::costmap {

/// One number against another that it should follow, at places some way apart.
class Response {
 public:
  void add(double cause, double effect) noexcept;

  /// Whether the effect follows the cause: the cause varied by at least so much (one standard deviation) and the
  /// slope of the regression lies at least four of its standard errors, and `least`, above 0.
  bool follows(double least, double variation) const noexcept;
  double meanDifference() const noexcept;  ///< effect less cause
  std::size_t size() const noexcept { return count_; }

 private:
  std::size_t count_ = 0;
  double cause_ = 0.0, effect_ = 0.0, causes_ = 0.0, effects_ = 0.0, product_ = 0.0;
};

/// Whether the sensors of a drive have shown, against each other, that they are sound, so that what they say may
/// raise a belief. Each proof needs something that a sensor which is stuck, biased, displaced or silent does not
/// give; without it there is none (all limits ours):
///
/// slip        rises with the slope that is climbed, and is not below what level ground takes
/// slope       as the rover measured it follows the map's where the rover says it is
/// torque,     taken together as pull, follow the slope and are not off it
/// sinkage
/// pose        moves from row to row by no more than it did before; after a jump nothing is proven until it is
///             back, since either side of the jump may be the wrong one
class SensorProof {
 public:
  /// What one wheel read, and what is known about its place. NaN = not known.
  struct Row {
    std::string run, wheel;
    WheelReading reading;
    double measured_gradient = 0.0;  ///< along the heading, by the rover
    double map_gradient = 0.0;       ///< the same by the map
    double level_slip = 0.0;         ///< of ground of the class where it is level
    double torque_pull = 0.0;        ///< drawbar pull over load by torque and sinkage
  };

  void take(const Row& row);

  /// Whether the pull that the wheel read may raise a belief, and whether the sinkage may.
  bool pullSound(const std::string& run, const std::string& wheel) const;
  bool sinkageSound(const std::string& run, const std::string& wheel) const;
  /// Whether the pose, after the rows so far, is off by a jump.
  bool displaced(const std::string& run) const;
  /// Jumps of the pose.
  std::size_t jumps() const noexcept { return jumps_; }

 private:
  struct Wheel {
    std::optional<WheelReading> last, last_counted;
    Response slip, torque;
    std::size_t level_rows = 0;
    double level_excess = 0.0;
  };
  struct Run {
    Response slope;
    double fastest_mps = 0.0;
    maps::Point off{0.0, 0.0};  // sum of the jumps
  };

  void follow(Run& run, Wheel& wheel, const WheelReading& reading);
  bool placeSound(const Run& run) const noexcept;

  std::map<std::string, Run> runs_;
  std::map<std::string, Wheel> wheels_;
  std::size_t jumps_ = 0;
};

}  // namespace talus::costmap
