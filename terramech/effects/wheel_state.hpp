#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// One wheel as it is driven, before anything is known of what the soil answers: all that a model may depend
/// on. NaN = not known; a model part that needs it then stays neutral.
struct WheelState {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Wheel wheel;
  double load_N = 0.0;          ///< > 0
  double slip = 0.0;            ///< [-1, 1], as the sensors give it
  double slip_angle_rad = 0.0;  ///< between wheel plane and travel
  double speed_mps = kUnknown;
  double rim_speed_mps = kUnknown;
  double time_s = kUnknown;
  double pass_index = kUnknown;   ///< how often this track was driven, this pass included
  double slope_rad = kUnknown;    ///< along the heading, uphill > 0
  double gravity_m_s2 = 9.80665;  ///< > 0, of the body it drives on

  /// Readings that the linear formula starts from; no other model uses them.
  double measured_torque_Nm = kUnknown;
  double measured_sinkage_m = kUnknown;

  std::vector<std::pair<std::string, double>> extra;       ///< further numeric columns
  std::vector<std::pair<std::string, std::string>> group;  ///< text columns: wheel, session, source, ...

  /// Value of a numeric column by its name in telemetry files: one of stateColumns() or of `extra`; NaN when unknown. "constant" and
  /// the name of a grouping column have the value 1.
  double covariate(std::string_view name) const;

  /// Sets a numeric column that covariate() finds, as if it had been measured so; a count is rounded, other names are ignored.
  void setCovariate(std::string_view name, double value);

  /// Text of a grouping column; empty when there is none of that name.
  std::string_view label(std::string_view column) const;
};

/// Names of the columns that WheelState has fields for.
const std::vector<std::string>& stateColumns();

}  // namespace talus::terramech
