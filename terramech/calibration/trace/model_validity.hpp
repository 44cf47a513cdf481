#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Conclusion whether the model of a rigid wheel on soil, with physical effects, applies to a table.
struct Applicability {
  bool applies = true;   ///< true if the model describes the rows
  std::string reason;    ///< reason why the model does not apply; otherwise empty
  bool possible = true;  ///< true if a wheel on soil can have the median readings
};

/// Tests whether the median of DP/W is at most 1 and that of T/(rW) at most 1.5, and then the physical model, i.e. without empirical curves and sensor faults, on held-out rows. Only channels
/// that vary are tested: the scatter must exceed twice the noise or, for torque and sinkage, a quarter of the
/// mean. The model must explain at least half of the variance in one channel, and in no channel may its mean
/// square error exceed twice the variance. If drawbar pull, torque and sinkage are measured together, the
/// soil-independent relation of closureErrors() is tested as well: the median error of this relation and the
/// rms error of the model in DP/W must not both exceed 0.15. All limits are ours.
Applicability applicability(const TraceResult& result, const TraceOptions& options);

/// Returns for each row the measured DP/W minus the value that torque T and sinkage z imply for any soil
/// (kang_2003, Eq. 3.12); NaN if a value is missing:
///   DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW)
///   theta_1 = acos(1 - z/r)
/// The relation has an error of 0.03 for soils of 0 to 3 kPa and 20 to 37 deg.
std::vector<double> closureErrors(const Trial& trial);

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

/// Tests whether the model of a rigid wheel on soil describes the rows of a table, with the criterion of
/// model_validity.hpp. The test is made first with the soil alone, then with the effects that residual
/// tracing finds. The test uses a sample of at most 400 rows. `base` is a soil or model file; if empty, the
/// soil is fitted. `rover` supplies the wheel. For a table with insufficient data (fewer than 20 rows, or no
/// load, slip or wheel) the model counts as applicable. Throws InputError for unreadable files.
Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch = {});

}  // namespace talus::terramech
