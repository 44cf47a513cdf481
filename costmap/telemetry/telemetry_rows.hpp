#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/common/checksum.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/evidence.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Computes the identifier of a drive that is received in parts: a checksum of the used columns of each row,
/// ordered by column name, as 16 hexadecimal digits. The order of a file's columns and unused columns have no
/// effect.
class DriveId {
 public:
  /// Adds the next part of the drive.
  void add(const terramech::Telemetry& telemetry);
  /// Returns the identifier of the parts so far.
  std::string text() const;

 private:
  Checksum sum_{};
};

/// Returns the number of a drive in a map (WheelObservation::drive): a checksum of the first row of the
/// drive, so that further rows of a file that grew, or of further parts, belong to the same drive. Two drives
/// with the same number, of 65 536 possible numbers, count as one drive.
std::uint16_t driveTag(const terramech::Telemetry& telemetry);

/// Number of rows in the beginning of a drive: `rows` accepted by the file's reader, and `rejected` by it.
struct DriveBeginning {
  std::size_t rows = 0, rejected = 0;
};

/// Returns the longest beginning of a telemetry whose identifier is among `drives`, i.e. the known rows of a
/// file that grew.
DriveBeginning knownBeginning(const terramech::Telemetry& telemetry,
                              const std::map<std::string, TraversabilityMap::Drive>& drives);

/// Return the names of the number columns and of the text columns that TelemetryRows reads, sorted.
std::span<const std::string_view> usedNumberColumns() noexcept;
std::span<const std::string_view> usedWordColumns() noexcept;

/// Converts the rows of a telemetry file to readings on a map. Keeps references to the file and the map.
class TelemetryRows {
 public:
  /// Makes the readings. `pose_std_m` is the position uncertainty [m] of rows without a value in the column
  /// pose_std_m. Throws InputError if the column x_m, y_m, load_N or slip is missing.
  TelemetryRows(const terramech::Telemetry& telemetry, const TraversabilityMap& map, double pose_std_m);

  std::size_t size() const noexcept { return x_.size(); }

  /// Returns the reading of row i. The gradient along the heading is tan(slope_rad) and the gradient across
  /// is tan(roll_rad); gradients whose columns are missing are those of the map.
  TelemetryReading reading(std::size_t i) const;
  double heading(std::size_t i) const { return value(heading_, i); }
  std::string wheel(std::size_t i) const { return wheel_ ? (*wheel_)[i] : std::string(); }
  std::string run(std::size_t i) const { return run_ ? (*run_)[i] : std::string(); }
  /// Returns the name of the time series to which row i belongs: run and wheel.
  std::string series(std::size_t i) const { return run(i) + '/' + wheel(i); }
  /// Returns true if wheel_radius_m and wheel_width_m of row i are those of the map's rover, or are missing.
  bool ofRover(std::size_t i) const;
  /// Return the gradient along the heading (rise over run) of row i: measuredGradient() as measured by the
  /// rover, mapGradient() from the map. NaN: unknown.
  double measuredGradient(std::size_t i) const;
  double mapGradient(std::size_t i) const { return mapGradient(reading(i), heading(i)); }
  /// Returns the lowest possible gradient along the heading: the lower of the measured gradient and the
  /// map's, or steepestDescent() if both are unknown.
  double leastGradient(std::size_t i) const;
  /// Returns the lowest possible gradient of a row whose heading is unreliable: the steepest descent of the
  /// map at the position, or the measured gradient if lower.
  double steepestDescent(std::size_t i) const;

  /// Returns the second slip of row i, 1 - v/(r omega), with v by speed_mps, or by the odometry or the poses
  /// over the last kSecondWay_m, and r omega by rim_speed_mps or wheel_rate_rad_s. NaN: unknown, or computed
  /// from the same speed or poses as the slip.
  double secondSlip(std::size_t i) const { return second_.empty() ? value(nullptr, i) : second_[i]; }
  /// Returns the standard deviation of secondSlip() by the scatter of the positions [-].
  double secondStd() const noexcept { return second_std_; }
  /// Returns what would settle a fault of the slip, as the end of a finding.
  const char* settles() const noexcept;
  static constexpr double kSecondWay_m = 2.0;

  /// Returns the indices of all rows, grouped by moment, in the order of time. A moment is the rows of different
  /// wheels at one time of one run, wherever they are in the file; without times, subsequent rows of different
  /// wheels not farther apart than the rover is long.
  std::vector<std::vector<std::size_t>> byMoment() const;

 private:
  static double value(const std::vector<double>* column, std::size_t i);
  // Returns the rows by run, time and wheel; those without time last, as in the file.
  std::vector<std::size_t> byTime() const;
  double mapGradient(const TelemetryReading& reading, double direction_rad) const;
  double measuredSlope(std::size_t i) const;
  double rimSpeed(std::size_t i) const;
  void measureSecond(const terramech::Telemetry& telemetry);

  const TraversabilityMap& map_;
  double pose_std_m_;
  const std::vector<double>&x_, &y_, &load_, &slip_;
  const std::vector<double>*time_, *torque_, *sinkage_, *z_, *slope_, *heading_, *pull_, *pass_, *pose_;
  const std::vector<double>*speed_, *rim_speed_, *roll_, *slip_angle_, *radius_, *width_;
  const std::vector<double>* rate_;
  const std::vector<std::string>*wheel_, *run_;
  std::vector<std::size_t> order_;
  std::vector<double> second_;
  double second_std_ = 0.0;
  bool copied_ = false;  // true if the second slips were computed from the first
};

/// The readings of all wheels at one time. If all wheels have the same load although the rover is on a slope,
/// the load column is an even share of the weight and not a measurement; the loads are then computed from the
/// slope.
struct Moment {
  /// Indices of the rows.
  std::vector<std::size_t> rows;
  std::vector<TelemetryReading> readings;  ///< reading of each row in `rows`
  bool transferred = false;                ///< true if the loads were computed from the slope
};

/// Returns true if `value` equals the value `of_rover` of the rover within 1 %, or is NaN.
bool sameOrUnknown(double value, double of_rover) noexcept;

/// Returns true if the mean load of the wheels equals the mean wheel load of the rover within a quarter.
bool carriesRover(const std::vector<TelemetryReading>& readings, const terramech::Rover& rover) noexcept;

/// Returns the moment of the rows with the indices `of`, which contain one row per wheel.
Moment momentOf(const TelemetryRows& rows, std::vector<std::size_t> of, const terramech::Rover& rover);

}  // namespace talus::costmap
