#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/telemetry/response.hpp>
#include <talus/costmap/telemetry/step_watch.hpp>

namespace talus::costmap {

/// Verifies the sensors of a drive against each other: only readings of verified sensors may raise an
/// estimate. Each test checks a property that a stuck, biased, displaced or missing sensor does not have (all
/// limits ours).
///
/// Slip: the slip increases with the slope. At least 6 rows are on level ground, and the slip there has no
/// step, because the slip on either side of a step may be wrong. The slips of the wheels of one moment are
/// proportional: the regression of the slip of a wheel on the mean slip of all wheels has a slope within 0.25
/// of 1, by three standard errors, because the wheels of a rover share its speed. The deviation of a wheel from
/// that mean does not increase with the mean by more than 0.2 times, with the same certainty, so that a fault
/// that changes from wheel to wheel is found as well.
///
/// Slope: the measured slope increases with the map's slope at the rover's position and differs from it by at
/// most 0.03 on average. Its scale against the map's slope exceeds 1.15 by at most two standard errors.
///
/// Torque and sinkage: both, converted to a pull over load, increase with the slope and differ from it by at
/// most 0.08 on average.
///
/// Position: the position moves between rows no further than the speed of earlier rows explains. After a jump
/// no sensor is verified until the position returns, because the position on either side may be wrong.
class SensorProof {
 public:
  /// Measurements of one wheel at one time, and data of its place. NaN: unknown.
  struct Row {
    std::string run, wheel;
    TelemetryReading reading;
    double measured_gradient = 0.0;  ///< gradient along the heading, measured by the rover [-]
    double map_gradient = 0.0;       ///< gradient along the heading, from the map [-]
    double class_slip = 0.0;         ///< slip of a wheel on the terrain class at the measured gradient [-]
    double torque_pull = 0.0;        ///< drawbar pull over load from torque and sinkage [-]
    /// Thrust of the class at the measured slip over its thrust at the reference slip [-].
    double share = 0.0;
    /// Mean slip of all wheels at this time [-]; NaN: one wheel.
    double mean_slip = std::numeric_limits<double>::quiet_NaN();
    bool danger = false;  ///< true if the row indicates danger: it is then used for the position only
  };

  /// Least step of the slip on level ground that is detected [-].
  static constexpr double kLevelStep = 0.04;
  void take(const Row& row);

  /// Returns true if the rows so far verify the sensors from which the pull of a wheel is computed.
  bool pullSound(const std::string& run, const std::string& wheel) const {
    return failedTest(run, wheel) == FailedTest::Nothing;
  }
  /// Tests of the verification, in their order; Nothing means that no test fails. Pose: position; SlopeRows:
  /// number of rows with a slope; Slopes: variation of the slopes; Slope, SlopeBias, SlopeScale: measured
  /// slope; Slip: slip over slope; WheelScale: slips of the wheels; LevelRows, SlipStep: slip on level ground.
  enum class FailedTest : std::uint8_t {
    Nothing,
    Pose,
    SlopeRows,
    Slopes,
    Slope,
    SlopeBias,
    SlopeScale,
    Slip,
    WheelScale,
    LevelRows,
    SlipStep
  };
  FailedTest failedTest(const std::string& run, const std::string& wheel) const;
  /// Returns the first test that fails for any wheel.
  FailedTest failedTest() const;
  /// Returns a failed test as text, with its remedy.
  static const char* text(FailedTest failedTest) noexcept;
  /// Returns true if torque and sinkage are verified, too.
  bool torqueSound(const std::string& run, const std::string& wheel) const;
  /// Returns true if the last rows contradict the verification by earlier rows.
  bool isSuspect(const std::string& run, const std::string& wheel) const;
  /// Returns true if the position is displaced by a jump in the rows so far.
  bool displaced(const std::string& run) const;
  /// Returns true if enough rows of the wheel are at slips that mobilise most of the thrust of the class.
  bool mobilised(const std::string& run, const std::string& wheel) const;
  /// Returns the mean of the measured gradient minus the map's gradient in a run [-]; 0 without rows.
  double gradientExcess(const std::string& run) const;
  /// Returns the number of wheels with rows in a run.
  std::size_t wheels(const std::string& run) const;

 private:
  struct Wheel {
    std::optional<TelemetryReading> last, last_counted;
    ResponseSeries slip, torque;
    std::size_t level_rows = 0, mobilised_rows = 0;
  };
  struct Run {
    ResponseSeries slope;
    double fastest_mps = 0.0;
    maps::Point off{0.0, 0.0};  // sum of the jumps
    std::map<std::string, Wheel> wheels;
  };

  bool slopeScaled(const Run& run) const noexcept;
  bool slipScaled(const std::string& wheel) const noexcept;
  static void follow(Run& run, const Wheel& wheel, const TelemetryReading& reading);
  void takeLevel(Wheel& wheel, const Row& row);
  const Run* find(const std::string& run) const;
  static const Wheel* find(const Run& run, const std::string& wheel);

  std::map<std::string, Run> runs_;
  Response slopes_;  // regression over all runs, which share one slope sensor
  // by wheel over all runs, which share the slip sensor of the wheel: detectors of steps, and regressions of
  // the slip on the mean slip of all wheels
  std::map<std::string, StepWatch> level_steps_;
  std::map<std::string, Response> wheel_scales_;
  Response wheel_spread_;  // deviation of a wheel's slip from the mean of all, over the size of that mean
};

}  // namespace talus::costmap
