#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

namespace talus::terramech {

/// Rows of wheel telemetry that are usable by an estimator, and rejected rows.
struct WheelRows {
  std::string source;     ///< file name
  Wheel wheel;            ///< wheel of the first row; of all rows if one_wheel is true
  bool one_wheel = true;  ///< false: wheels of several sizes
  std::vector<WheelSample> samples;
  std::vector<Wheel> wheels;            ///< one per sample
  std::vector<std::size_t> lines;       ///< line of each sample in the file
  std::vector<Telemetry::Words> words;  ///< text columns of the file, one value per sample
  std::vector<std::string> ignored;     ///< numeric columns of the file that are not used
  /// Rows rejected by the reader or by the method, in the order of the file.
  std::vector<RejectedRow> rejected;
  /// Returns the samples with their wheels.
  std::vector<WheelReading> readings() const;

  const RejectedRow* firstRejected() const { return rejected.empty() ? nullptr : &rejected.front(); }
};

/// Options of readWheelRows().
struct WheelRowOptions {
  /// Rover that supplies the wheel of all rows; empty: wheel_radius_m and wheel_width_m of the file.
  std::string rover;
  bool needs_slip = true;  ///< true: rows without slip > 0 are rejected
  double deepest = 2.0;    ///< rows with z/r at or above this value are rejected, (0, 2]
};

/// Largest slip angle [rad] at which a wheel is treated as straight: up to this angle, torque and sinkage of
/// sandy_loam under mer differ by less than 3 % from those at angle 0.
inline constexpr double kStraightUpTo_rad = 0.1;

/// Moves rows with a side force but without the slip angle at which it was measured to `rejected`, because
/// the wheel was not straight. Throws InputError if no row is left.
void leaveOutWithoutSlipAngle(Telemetry& telemetry);

/// Reads load_N, torque_Nm, sinkage_m and, if needed, slip. Rejects rows without contact (sinkage 0), with a
/// slip angle above kStraightUpTo_rad, with a side force but no slip angle, with too large a sinkage, or with
/// slip <= 0 if slip is needed. Throws InputError if a column is missing, a row has no wheel, or no row is
/// left.
WheelRows readWheelRows(const TableFile& file, const WheelRowOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
