#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Design of the next experiment: runs for which the remaining causes differ most, and scores of the causes
/// from measured runs.
namespace talus::terramech {

/// A possible cause, and the model that includes it.
struct Cause {
  std::string name;
  RefinedModel model;
};

/// The refined model, then the refined model with one effect replaced by a rival. Rivals are the causes that
/// the rows cannot distinguish from the effect or, without such causes, the candidate with the next greatest
/// gain. If no candidate has a gain, returns the refined model alone.
std::vector<Cause> causesOf(const TraceResult& result);

/// A cause's prediction of the mean of a run's rows, in the unit of each answer; NaN for answers that the
/// table does not measure.
struct RunPrediction {
  std::string cause;
  std::array<double, kChannels> mean{}, std{};
};

/// A proposed run: constant conditions, and rows that differ in slip.
struct ProposedRun {
  std::vector<std::pair<std::string, double>> columns;      ///< numeric columns except slip
  std::vector<std::pair<std::string, std::string>> groups;  ///< text columns
  std::vector<double> slip;                                 ///< of its rows, ascending
  std::vector<std::vector<RunPrediction>> row_predictions;  ///< for each row, of each cause
  std::vector<RunPrediction> predictions;                   ///< mean of the rows, of each cause
};

/// Proposes at most `count` runs, in the order of selection, within the range of the rows. Columns of the
/// causes and the load have the values at the ends and in the middle of their ranges; other columns have the
/// values of the middle row. Each run minimises the sum over pairs of causes of exp(-B), with B the
/// Bhattacharyya distance of their predictions (bhattacharyya_1943), which bounds the probability of
/// confusing the causes. Predictions include the errors of sensors, parameters and the error shared by rows
/// of a run.
std::vector<ProposedRun> proposeRuns(const TraceResult& result, int count);

/// Score of a cause from measured rows.
struct CauseScore {
  std::string cause;
  double log_likelihood = 0.0;
  double probability = 0.0;  ///< posterior for equal prior probabilities of the causes
};

/// Scores of all causes, in the order of causesOf().
std::vector<CauseScore> scoreCauses(const TraceResult& result, const Trial& measured);

}  // namespace talus::terramech
