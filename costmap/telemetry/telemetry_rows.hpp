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

/// The columns that TelemetryRows reads, sorted by name.
std::span<const std::string_view> usedNumberColumns() noexcept;
std::span<const std::string_view> usedWordColumns() noexcept;

/// The columns of a telemetry file as readings on a map. Keeps references to both.
class TelemetryRows {
 public:
  /// `pose_std_m`: of rows that do not say it. Throws InputError when x_m, y_m, load_N or slip is missing.
  TelemetryRows(const terramech::Telemetry& telemetry, const TraversabilityMap& map, double pose_std_m);

  std::size_t size() const noexcept { return x_.size(); }

  /// The slope is the row's own, slope_rad along the heading and roll_rad across it; without it the map's.
  TelemetryReading reading(std::size_t i) const;
  double heading(std::size_t i) const { return value(heading_, i); }
  std::string wheel(std::size_t i) const { return wheel_ ? (*wheel_)[i] : std::string(); }
  std::string run(std::size_t i) const { return run_ ? (*run_)[i] : std::string(); }
  /// Wheel and run together name a series in time.
  std::string series(std::size_t i) const { return run(i) + '/' + wheel(i); }
  /// Whether the row's wheel is that of the map's rover, as far as its columns wheel_radius_m and wheel_width_m say.
  bool ofRover(std::size_t i) const;
  /// Along the heading, as the rover measured it and as the map has it; NaN = not known.
  double measuredGradient(std::size_t i) const;
  double mapGradient(std::size_t i) const { return mapGradient(reading(i), heading(i)); }
  /// The least that the slope along the heading may have been: of what was measured and what the map has, or the
  /// map's steepest descent where the heading is not known.
  double leastGradient(std::size_t i) const;
  /// The same of a row whose other numbers are not to be trusted: the map's steepest descent, or less where measured.
  double steepestDescent(std::size_t i) const;

  /// All rows by moment: those of different wheels that were read at one time of one run. Neither the order of the
  /// moments' rows in the file nor that of runs that were read together shows, beyond the rows' numbers.
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

/// The readings of one moment, with the loads that the slope gives them where the file has all wheels carry
/// the same: such a column is the weight's even share and not a measurement.
struct Moment {
  std::vector<std::size_t> rows;
  std::vector<TelemetryReading> readings;  ///< of each of them
  bool transferred = false;                ///< whether the loads are computed
};

/// Whether a number of a wheel is that of another, or not known.
bool sameOrUnknown(double value, double of_rover) noexcept;

/// Whether the wheels of a moment carry what the rover has them carry, on average, within a quarter.
bool carriesRover(const std::vector<TelemetryReading>& readings, const terramech::Rover& rover) noexcept;

/// The moment of some rows, one a wheel.
Moment momentOf(const TelemetryRows& rows, std::vector<std::size_t> of, const terramech::Rover& rover);

}  // namespace talus::costmap
