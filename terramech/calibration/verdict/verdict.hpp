#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// What tracing can say of a table.
enum class Verdict {
  Explained,       ///< effects were found that carry most, more than half, of what was more than noise
  NothingMissing,  ///< no effect, and what is left is no more than the sensors err
  Unexplained      ///< more is left than the sensors err, and no cause was accepted for most of it
};

/// "explained", "nothing_missing" or "unexplained".
const char* name(Verdict verdict);

/// The answer of a trace, and where the most is left.
struct Answer {
  Verdict verdict = Verdict::NothingMissing;
  Channel channel = Channel::DrawbarPull;  ///< whose rest exceeds its floor most
  bool open = false;                       ///< some rest exceeds its floor
  double rest = 0.0, floor = 0.0;          ///< rms there of the refined model, and of the sensors alone [-]
  std::string column;                    ///< over which the rest varies most; empty: over none that is known
  double gain = 0.0;                     ///< what that column promises, against TraceResult::threshold
  std::vector<StrainedSensor> strained;  ///< sensors that would have to err far more than stated
  std::vector<std::string> unstated;     ///< columns of whose error nothing is stated: it is the fitted one
  /// Standard deviations from run to run of the logarithms of the soil's strength and stiffness, where they make
  /// most of what is left; 0 elsewhere.
  double strength_scatter = 0.0, stiffness_scatter = 0.0;
  std::string unit = "run";  ///< what rows share that error in: a run, or a stretch of time
  std::string inapplicable;  ///< why the model does not apply; empty where it does
  std::string measure;       ///< rows that would decide; empty where nothing exceeds its floor
};

/// The floor is that of the sensors as they are stated, where they would have to err far more than that; without a
/// statement that of the fitted noise. A channel's rest exceeds its floor where its variance does by more than
/// three standard errors of the variance of as many normal errors. Found effects explain where they carry more than
/// half of what the base model leaves above the floor.
Answer answerOf(const TraceResult& result);

/// A parameter of the soil that the rows moved far from what was known of it.
struct MovedParameter {
  std::string name;
  double value = 0.0, prior = 0.0, prior_std = 0.0;
  double away() const;  ///< [prior standard deviations]
};

/// Those of the refined model's soil that stand more than three standard deviations from their prior.
std::vector<MovedParameter> movedSoil(const TraceResult& result);

/// Names of fitted numbers of the refined model's soil that stand at a bound of their range.
std::vector<std::string> soilAtBounds(const RefinedModel& model);

/// Names of fitted numbers of an effect that stand at a bound of their range.
std::vector<std::string> atBounds(const Effect& effect);

/// The refined model as predictions need it: what rows of a new run share is an error of theirs, too, and so is what
/// held-out rows show beyond that and the floor (by three standard errors): what nothing explains.
RefinedModel forPrediction(const TraceResult& result);

}  // namespace talus::terramech
