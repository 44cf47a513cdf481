#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Conclusion of a trace.
enum class Verdict {
  Explained,       ///< found effects explain more than half of the residual above noise
  NothingMissing,  ///< no effect found; residual within the sensor errors
  Unexplained      ///< residual above the sensor errors, mostly without an accepted cause
};

/// "explained", "nothing_missing" or "unexplained".
const char* name(Verdict verdict);

/// Conclusion of a trace, with the largest remaining residual.
struct Answer {
  Verdict verdict = Verdict::NothingMissing;  ///< the conclusion
  Channel channel = Channel::DrawbarPull;     ///< channel whose residual exceeds its floor most
  bool open = false;                          ///< some residual exceeds its floor
  double rest = 0.0, floor = 0.0;             ///< rms residual of the refined model in `channel`, and rms
                                              ///< sensor error [-]
  std::string column;                         ///< column over which the residual varies most; may be empty
  double gain = 0.0;                          ///< gain of that column, to compare with TraceResult::threshold
  std::vector<StrainedSensor> strained;       ///< sensors whose error would be far larger than stated
  std::vector<std::string> unstated;          ///< measured columns without a stated error
  /// Standard deviations between runs of the logarithms of soil strength and stiffness, if they cause most of
  /// the residual; otherwise 0.
  double strength_scatter = 0.0, stiffness_scatter = 0.0;
  std::string unit = "run";  ///< unit of rows that share the error: a run, or a stretch of time
  std::string inapplicable;  ///< reason why the model does not apply; empty if it applies
  std::string measure;       ///< measurements that would discriminate; empty if no residual exceeds its floor
};

/// Derives the conclusion. The floor is the rms of the fitted noise, or of the stated sensor errors if the
/// fitted errors are far larger than stated. A residual exceeds its floor if its variance is larger by more
/// than three standard errors of the variance of the same number of normal errors. The verdict is Explained
/// if the found effects explain more than half of the base model's residual above the floor.
Answer answerOf(const TraceResult& result);

/// A soil parameter that the rows moved far from its prior.
struct MovedParameter {
  std::string name;                                  ///< as in soilParameters()
  double value = 0.0, prior = 0.0, prior_std = 0.0;  ///< fitted value, and mean and std of the prior
  double away() const;                               ///< (value - prior) / prior_std
};

/// Soil parameters of the refined model more than three standard deviations from their prior.
std::vector<MovedParameter> movedSoil(const TraceResult& result);

/// Names of fitted soil parameters of the refined model at a bound of their range.
std::vector<std::string> soilAtBounds(const RefinedModel& model);

/// Names of fitted parameters of an effect at a bound of their range.
std::vector<std::string> atBounds(const Effect& effect);

/// Returns the refined model with additional error terms for predictions: the error shared by rows of a new
/// run, and the unexplained error of held-out rows, i.e. the part that exceeds the shared error and the floor
/// by three standard errors.
RefinedModel forPrediction(const TraceResult& result);

}  // namespace talus::terramech
