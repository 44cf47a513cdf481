#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <talus/terramech/calibration.hpp>

/// Design of the next experiment. The proposed runs are those for which the predictions of the possible
/// causes of a residual differ most. Measured runs then score the causes.
namespace talus::terramech {

/// Possible cause of the residual, with the model that includes this cause.
struct Cause {
  std::string name;
  RefinedModel model;
};

/// Returns the causes: first the refined model, then the refined model with one effect replaced by a rival.
/// Rivals are the causes that the rows cannot distinguish from the effect or, if no such cause exists, the
/// candidate with the next greatest gain. If no candidate has a gain, returns only the refined model.
std::vector<Cause> causesOf(const TraceResult& result);

/// Prediction by a cause of the mean over the rows of a run, in the unit of each measured column; NaN for
/// columns that the table does not measure.
struct RunPrediction {
  std::string cause;
  std::array<double, kChannels> mean{}, std{};
};

/// Proposed run: conditions that are constant over the run, and rows that differ in slip.
struct ProposedRun {
  std::vector<std::pair<std::string, double>> columns;      ///< values of the numeric columns except slip
  std::vector<std::pair<std::string, std::string>> groups;  ///< texts of the text columns
  std::vector<double> slip;                                 ///< slip of each row, ascending
  std::vector<std::vector<RunPrediction>> row_predictions;  ///< prediction for each row by each cause
  std::vector<RunPrediction> predictions;  ///< prediction for the mean of the rows by each cause
};

/// Proposes at most `count` runs, in the order of selection, within the range of the rows. The columns of the
/// causes and the load have the values at the ends and in the middle of their ranges; other columns have the
/// values of the middle row. Each run minimises the sum over pairs of causes of exp(-B), where B is the
/// Bhattacharyya distance of their predictions (bhattacharyya_1943). This sum bounds the probability of
/// confusing the causes. Predictions include the errors of sensors and parameters, and the error shared by
/// the rows of a run.
std::vector<ProposedRun> proposeRuns(const TraceResult& result, int count);

/// Score of a cause, given measured rows.
struct CauseScore {
  std::string cause;
  double log_likelihood = 0.0;
  double probability = 0.0;  ///< posterior probability for equal prior probabilities of the causes
};

/// Returns the scores of all causes given the rows `measured`, in the order of causesOf().
std::vector<CauseScore> scoreCauses(const TraceResult& result, const Trial& measured);

}  // namespace talus::terramech
