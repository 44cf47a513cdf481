#pragma once

#include <optional>
#include <string>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// A column whose values are a multiple of the quantity that its name states.
struct ScaledColumn {
  std::string column;  ///< name of the column
  double scale = 1.0;  ///< factor by which its values are to be multiplied
  std::string reason;  ///< what the values are instead
  double gain = 0.0;   ///< log-likelihood that the base model gains over the model of the rows as read [-]

  /// Returns, for example, "load_N looks like kilograms: scale 9.81 (log-likelihood gain 812.3)".
  std::string text() const;
};

/// Returns the most likely scale of a column: load in kilograms, pull or torque in kilogram-force, readings of
/// two wheels, or a diameter in place of the radius. The base model, fitted to the rows with this scale, must
/// gain more than the threshold of the search over the model `present` on the rows as read. The likelihood is
/// that of the readings in the units of the file. Returns nullopt without such a scale, and for a rover's own
/// drive.
std::optional<ScaledColumn> likelyScale(const TraceResult& result, const RefinedModel& present,
                                        const TraceOptions& options);

}  // namespace talus::terramech
