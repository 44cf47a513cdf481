#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Operating state of one wheel: the input of a wheel model. NaN marks an unknown value; an effect that needs
/// an unknown value is not applied.
struct WheelState {
  /// Value of an unknown quantity.
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Wheel wheel;
  double load_N = 0.0;              ///< vertical load, > 0
  double slip = 0.0;                ///< measured slip, [-1, 1]
  double slip_angle_rad = 0.0;      ///< slip angle from the wheel plane to the travel direction
  double speed_mps = kUnknown;      ///< travel speed of the wheel centre
  double rim_speed_mps = kUnknown;  ///< rim speed r omega
  double time_s = kUnknown;         ///< time of the reading
  double pass_index = kUnknown;     ///< number of wheel passes over this track, including this pass
  double slope_rad = kUnknown;      ///< slope along the heading, positive uphill
  double gravity_m_s2 = 9.80665;    ///< gravity at the driving site, > 0

  /// Readings that only the base model linear-formula uses.
  double measured_torque_Nm = kUnknown;
  double measured_sinkage_m = kUnknown;

  /// Further numeric columns of the telemetry row: name and value.
  std::vector<std::pair<std::string, double>> extra;
  /// Text columns of the row (wheel, session, source, ...): name and text.
  std::vector<std::pair<std::string, std::string>> group;

  /// Returns the value of a numeric column by its name in telemetry files. The column is one of
  /// stateColumns() or of `extra`; the value is NaN if unknown. "constant" and the name of a text column have
  /// the value 1. "a*b" is the product of the columns a and b.
  double covariate(std::string_view name) const;

  /// Sets the value of a numeric column of stateColumns() or of `extra`. pass_index is rounded to an integer.
  /// Other names are ignored.
  void setCovariate(std::string_view name, double value);

  /// Returns the text of a text column; empty if the state has no such column.
  std::string_view label(std::string_view column) const;
};

/// Returns the names of the telemetry columns that are fields of WheelState.
const std::vector<std::string>& stateColumns();

}  // namespace talus::terramech
