#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Kind of conclusion of a residual trace (search for the effects that a wheel model lacks).
enum class Verdict {
  Explained,       ///< with the found effects, each channel of held-out rows is within 1.3 floors
  NothingMissing,  ///< no effect was found, and the residual is within the sensor errors
  Unexplained      ///< the residual exceeds the sensor errors; the found effects may explain a part of it
};

/// Returns "explained", "nothing_missing" or "unexplained".
const char* name(Verdict verdict);

/// Conclusion of a residual trace, with the largest remaining residual. The floor of a channel is the rms
/// that sensor errors cause.
struct Answer {
  Verdict verdict = Verdict::NothingMissing;  ///< kind of conclusion
  Channel channel = Channel::DrawbarPull;     ///< channel whose held-out error exceeds its floor most
  /// Rms errors of the base and of the refined model on held-out rows in `channel`, and its floor [-].
  double base = 0.0, rest = 0.0, floor = 0.0;
  std::vector<std::string> at_bound;  ///< fitted parameters at a bound of their range, with their effect
  std::string column;                 ///< column on which the remaining residual depends most; may be empty
  double gain = 0.0;  ///< gain of a candidate of that column, for comparison with TraceResult::threshold
  std::vector<StrainedSensor> strained;  ///< sensors whose fitted error is far larger than stated
  std::vector<std::string> unstated;     ///< measured columns without a stated error
  /// Standard deviations between runs of the logarithms of soil strength and soil stiffness, if these cause
  /// most of the residual; otherwise 0.
  double strength_scatter = 0.0, stiffness_scatter = 0.0;
  std::string unit = "run";  ///< kind of rows that share an error: a run, or a stretch of time
  std::string inapplicable;  ///< reason why the model does not apply; empty if it applies
  /// Measurements that would discriminate between the causes; empty unless the verdict is Unexplained.
  std::string measure;
};

/// Returns the conclusion of a trace. The floor of a channel is the rms of the fitted noise, or of the stated
/// sensor errors if the fitted errors are far larger than stated. The verdict is Explained if effects were
/// found, no held-out channel exceeds 1.3 floors, and no fitted parameter is at a bound of its range. It is
/// NothingMissing if no effect was found, no residual exceeds its floor by more than three standard errors of
/// the variance of the same number of normal errors, and either no held-out channel exceeds 1.3 floors or no
/// candidate promises more than noise.
Answer answerOf(const TraceResult& result);

/// Soil parameter whose fitted value is far from its prior.
struct MovedParameter {
  std::string name;  ///< name in soilParameters()
  /// Fitted value, and mean and standard deviation of the prior.
  double value = 0.0, prior = 0.0, prior_std = 0.0;
  double away() const;  ///< returns (value - prior) / prior_std
};

/// Returns the soil parameters of the refined model that are more than three standard deviations from their
/// prior.
std::vector<MovedParameter> movedSoil(const TraceResult& result);

/// Returns the names of fitted soil parameters of a refined model that are at a bound of their range.
std::vector<std::string> soilAtBounds(const RefinedModel& model);

/// Returns the names of fitted parameters of an effect that are at a bound of their range.
std::vector<std::string> atBounds(const Effect& effect);

/// Returns the refined model with additional error terms for predictions: the error that the rows of a new
/// run share, and the unexplained error of held-out rows. The unexplained error is the part of the held-out
/// error that exceeds the shared error and the floor by more than three standard errors.
RefinedModel forPrediction(const TraceResult& result);

}  // namespace talus::terramech
