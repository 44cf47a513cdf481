#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// The next experiment: runs in which the causes that are left differ most, and what measured runs say of each cause.
namespace talus::terramech {

/// A cause, and the model in which it acts.
struct Cause {
  std::string name;
  RefinedModel model;
};

/// The refined model, followed by the same model with one effect replaced by a rival. Rivals are the causes that the rows cannot
/// separate from the effect; if there are none, the candidate with the next greatest gain. Only the refined model if no candidate gains.
std::vector<Cause> causesOf(const TraceResult& result);

/// What a cause predicts of the mean of a run's rows, in the unit of each answer; NaN where the table does not measure it.
struct RunPrediction {
  std::string cause;
  std::array<double, kChannels> mean{}, std{};
};

/// A run to make: conditions that it keeps, and its rows, which differ in slip.
struct ProposedRun {
  std::vector<std::pair<std::string, double>> columns;      ///< but slip
  std::vector<std::pair<std::string, std::string>> groups;  ///< text columns
  std::vector<double> slip;                                 ///< of its rows, ascending
  std::vector<std::vector<RunPrediction>> row_predictions;  ///< of each row, of each cause
  std::vector<RunPrediction> predictions;                   ///< of the mean of its rows, of each cause
};

/// At most `count` runs, in the order of choice, within the range of the rows: columns of the causes and the load at the
/// ends and the middle of their ranges, the others as in the middle row. Each is the one that lowers the sum over pairs of
/// causes of exp(-B) most, B being the Bhattacharyya distance of their predictions (bhattacharyya_1943), a bound of the chance to
/// take one for the other. Predictions hold the errors of sensors, parameters and what rows of a run share.
std::vector<ProposedRun> proposeRuns(const TraceResult& result, int count);

/// What measured rows say of a cause.
struct CauseScore {
  std::string cause;
  double log_likelihood = 0.0;
  double probability = 0.0;  ///< among the causes, each held for as likely before
};

/// Of each cause, in the order of causesOf().
std::vector<CauseScore> scoreCauses(const TraceResult& result, const Trial& measured);

}  // namespace talus::terramech
