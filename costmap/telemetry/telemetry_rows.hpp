#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Names of the columns that TelemetryRows reads, sorted.
std::span<const std::string_view> usedNumberColumns() noexcept;
std::span<const std::string_view> usedWordColumns() noexcept;

/// The columns of a telemetry file as readings on a map. Keeps references to file and map.
class TelemetryRows {
 public:
  /// `pose_std_m`: position uncertainty of rows without a column pose_std_m [m]. Throws InputError if x_m,
  /// y_m, load_N or slip is missing.
  TelemetryRows(const terramech::Telemetry& telemetry, const TraversabilityMap& map, double pose_std_m);

  std::size_t size() const noexcept { return x_.size(); }

  /// Returns the reading of row i. Slopes are slope_rad along the heading and roll_rad across; missing slopes
  /// are those of the map.
  TelemetryReading reading(std::size_t i) const;
  double heading(std::size_t i) const { return value(heading_, i); }
  std::string wheel(std::size_t i) const { return wheel_ ? (*wheel_)[i] : std::string(); }
  std::string run(std::size_t i) const { return run_ ? (*run_)[i] : std::string(); }
  /// Name of a series in time: run and wheel.
  std::string series(std::size_t i) const { return run(i) + '/' + wheel(i); }
  /// True if wheel_radius_m and wheel_width_m are those of the map's rover or are missing.
  bool ofRover(std::size_t i) const;
  /// Gradient along the heading, as measured by the rover and from the map; NaN: unknown.
  double measuredGradient(std::size_t i) const;
  double mapGradient(std::size_t i) const { return mapGradient(reading(i), heading(i)); }
  /// Lowest possible gradient along the heading: the lower of the measured gradient and the map's, or
  /// steepestDescent() if both are unknown.
  double leastGradient(std::size_t i) const;
  /// Lowest possible gradient of a row whose heading is unreliable: the map's steepest descent, or the
  /// measured gradient if lower.
  double steepestDescent(std::size_t i) const;

  /// Returns the indices of all rows by moment: rows of different wheels at one time of one run. The order of
  /// rows within a moment, and of interleaved runs, affects only the indices.
  std::vector<std::vector<std::size_t>> byMoment() const;

 private:
  static double value(const std::vector<double>* column, std::size_t i);
  double mapGradient(const TelemetryReading& reading, double direction_rad) const;
  double measuredSlope(std::size_t i) const;

  const TraversabilityMap& map_;
  double pose_std_m_;
  const std::vector<double>&x_, &y_, &load_, &slip_;
  const std::vector<double>*time_, *torque_, *sinkage_, *z_, *slope_, *heading_, *pull_, *pass_, *pose_;
  const std::vector<double>*speed_, *rim_speed_, *roll_, *slip_angle_, *radius_, *width_;
  const std::vector<std::string>*wheel_, *run_;
};

/// The readings of one moment. If all wheels on a slope have the same load, the load column is an even share
/// of the weight and not a measurement: the loads are then computed from the slope.
struct Moment {
  std::vector<std::size_t> rows;
  std::vector<TelemetryReading> readings;  ///< of each row
  bool transferred = false;                ///< true if the loads are computed
};

/// True if `value` equals the rover's within 1 % or is NaN.
bool sameOrUnknown(double value, double of_rover) noexcept;

/// True if the mean load of the wheels is that of the rover's wheels within a quarter.
bool carriesRover(const std::vector<TelemetryReading>& readings, const terramech::Rover& rover) noexcept;

/// Makes the moment of the rows `of`, one row per wheel.
Moment momentOf(const TelemetryRows& rows, std::vector<std::size_t> of, const terramech::Rover& rover);

}  // namespace talus::costmap
