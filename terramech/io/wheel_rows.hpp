#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

namespace talus::terramech {

/// Rows of wheel telemetry that an estimator can use, and those that it cannot.
struct WheelRows {
  std::string source;     ///< the file
  Wheel wheel;            ///< of the first row, where all have the same
  bool one_wheel = true;  ///< false: wheels of several sizes
  std::vector<WheelSample> samples;
  std::vector<Wheel> wheels;            ///< of each sample
  std::vector<std::size_t> lines;       ///< of each sample in the file
  std::vector<Telemetry::Words> words;  ///< the file's columns of words, of each sample
  std::vector<std::string> ignored;     ///< the file's columns of numbers that are not read
  std::vector<RejectedRow> rejected;    ///< by the reader or by the method, in the file's order
  /// The samples with their wheels.
  std::vector<WheelReading> readings() const;

  const RejectedRow* firstRejected() const { return rejected.empty() ? nullptr : &rejected.front(); }
};

/// How rows are read.
struct WheelRowOptions {
  std::string rover;       ///< whose wheel it is, where the file has no wheel_radius_m and wheel_width_m
  bool needs_slip = true;  ///< slip > 0: the method needs a driven wheel that slips
  double deepest =
      2.0;  ///< over the radius: rows of wheels that sank as deep, or deeper, are left out, (0, 2]
};

/// A wheel counts as straight up to this slip angle [rad]: torque and sinkage of sandy_loam under mer then differ by less
/// than 3 % from those at angle 0.
inline constexpr double kStraightUpTo_rad = 0.1;

/// Leaves out rows with a side force, but without the slip angle that it was measured at, by name in `rejected`: they are those of
/// no straight wheel. Throws InputError when no row is left.
void leaveOutWithoutSlipAngle(Telemetry& telemetry);

/// Reads load_N, torque_Nm, sinkage_m and, where needed, slip. Leaves out rows without contact (sinkage 0), of a wheel at a
/// slip angle (what reads these rows knows straight wheels), with a side force and no slip angle, of one that sank too deep, or of
/// one that is not driven where slip is needed. Throws InputError when a column is missing, a row
/// has no wheel, or no row is left.
WheelRows readWheelRows(const TableFile& file, const WheelRowOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
