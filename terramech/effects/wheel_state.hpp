#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Operating state of one wheel, the input of a model. NaN means unknown; an effect that needs an unknown
/// value does not act.
struct WheelState {
  /// Marks an unknown value.
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Wheel wheel;
  double load_N = 0.0;              ///< > 0
  double slip = 0.0;                ///< [-1, 1], as measured
  double slip_angle_rad = 0.0;      ///< from the wheel plane to the travel direction
  double speed_mps = kUnknown;      ///< travel speed of the wheel centre
  double rim_speed_mps = kUnknown;  ///< r omega
  double time_s = kUnknown;
  double pass_index = kUnknown;   ///< number of passes over this track, including this pass
  double slope_rad = kUnknown;    ///< along the heading, positive uphill
  double gravity_m_s2 = 9.80665;  ///< gravity where the rover drives, > 0

  /// Readings used by the linear formula only.
  double measured_torque_Nm = kUnknown;
  double measured_sinkage_m = kUnknown;

  std::vector<std::pair<std::string, double>> extra;       ///< further numeric columns
  std::vector<std::pair<std::string, std::string>> group;  ///< text columns: wheel, session, source, ...

  /// Returns the value of a numeric column by its name in telemetry files, one of stateColumns() or of
  /// `extra`; NaN if unknown. "constant" and the name of a grouping column have the value 1, "a*b" is the
  /// product of columns a and b.
  double covariate(std::string_view name) const;

  /// Sets a numeric column of stateColumns() or of `extra`. A count is rounded; other names are ignored.
  void setCovariate(std::string_view name, double value);

  /// Returns the text of a grouping column; empty if there is no such column.
  std::string_view label(std::string_view column) const;
};

/// Returns the names of the columns that are fields of WheelState.
const std::vector<std::string>& stateColumns();

}  // namespace talus::terramech
