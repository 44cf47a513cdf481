#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/plot.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>
#include <talus/terramech/calibration/trace/run_proposal.hpp>

namespace talus::cli {

/// Returns the errors as {NAME: ERROR}; channels (measured quantities) without a value are omitted.
nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors);

/// Returns the errors of the base model and of the refined model as text: " NAME BASE -> REFINED" for each
/// channel.
std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined);

/// Name and values of predictions: one matrix row per table row, one matrix column per channel (measured
/// quantity).
using NamedPredictions = std::pair<std::string, Eigen::MatrixXd>;

/// Returns a plot of one channel over the slip, measured and predicted. Rows without slip, measurement or
/// prediction are omitted.
Plot overSlip(terramech::Channel channel, const terramech::Trial& trial,
              const std::vector<NamedPredictions>& predictions);

/// Returns the prediction errors on held-out rows as a table: base model, refined model, sensors alone and
/// plain regression.
std::string leftOutText(const std::vector<terramech::LeftOutErrors>& all);
nlohmann::ordered_json leftOutJson(const std::vector<terramech::LeftOutErrors>& all);

/// Returns a table of proposed test runs as CSV, one row per slip. Its columns are the conditions of the run;
/// empty columns for the channels to be measured; and, for each possible cause K of the residual, the name of
/// the cause, the predictions and their standard deviations (predicted_K_*).
std::string proposalTable(const std::vector<terramech::ProposedRun>& runs,
                          const terramech::TraceResult& result);

nlohmann::ordered_json proposalsJson(const std::vector<terramech::ProposedRun>& runs);
nlohmann::ordered_json scoresJson(const std::vector<terramech::CauseScore>& scores);

/// Returns one line of text per run, with the columns that vary in the table and, for each cause, the
/// prediction of the mean of the run's rows.
std::string proposalText(const std::vector<terramech::ProposedRun>& runs, const terramech::Trial& trial);

/// Returns one line of text per cause, with its score.
std::string causeScoreText(const std::vector<terramech::CauseScore>& scores);

/// Returns the columns that are correlated so strongly with the column `covariate` (|correlation| > 0.9) that
/// the rows cannot discriminate between them.
std::vector<std::string> confounded(const terramech::Trial& trial, const std::string& covariate);

/// Returns the column over which an effect varies; for an effect on a single group of rows, the column of the
/// group.
const std::string& covariateOf(const terramech::Effect& effect);

/// A fitted parameter of an effect.
struct FittedNumber {
  std::string name, unit;  ///< name and unit of the parameter; unit "-": dimensionless
  double value = 0.0, std = 0.0;
  bool at_bound = false;  ///< true if the value is at a bound of the parameter's range
};

/// Returns the fitted parameters of an effect of known form, in the order of the form; empty for a curve.
std::vector<FittedNumber> fittedNumbers(const terramech::TracedEffect& effect);

/// Returns a p-value as text; an upper bound if it is below 0.001 or below the resolution of the drawn
/// tables.
std::string pText(double p);

/// Returns the measurement that would discriminate between an effect and its closest alternative.
std::string separatingMeasurement(const terramech::Trial& trial, const terramech::TracedEffect& effect);

/// Returns one line of text about rows that were left out because the wheel is sunk to its axle; requires at
/// least one such row.
std::string beyondAxleText(const terramech::TableTrace& trace);

/// Returns the reason for which the best candidate effect of the last round was rejected: its gain, and the
/// threshold or check that rejected it. Returns an empty text if no candidate had a gain.
std::string refusal(const terramech::TraceResult& result);

/// Returns the reason for which a fitted candidate effect was not selected.
std::string refusal(const terramech::TraceResult& result, const terramech::Explanation& rejected);

/// Returns the answer in one line: nothing missing; explained, or partly explained, by named effects; or
/// unexplained with the reason. The line includes the channel of the answer, its errors on held-out rows
/// before and after, and, for an unexplained residual, the measurement that would identify its cause.
std::string verdictText(const terramech::TraceResult& result, const terramech::Answer& answer);

/// Contribution of an effect (deviation from the base model that was found in data) to the refined model.
struct EffectRole {
  /// True if the effect changes predictions; false: the model predicts the same without the effect and the
  /// terms that it replaces.
  bool adds = true;
  std::vector<std::string> takes_back;  ///< soil parameters whose term in the base model the effect removes
};

/// Returns the contributions of all effects, in order. EffectRole::adds is true if a prediction of any row
/// changes by more than 1e-5 of the scale of its channel, which is ten times the difference between the two
/// contact solvers.
std::vector<EffectRole> rolesOf(const terramech::TraceResult& result);

/// Returns one line of text about an effect that adds nothing; empty for other effects.
std::string roleText(const EffectRole& role);

/// Return the whole analysis of a table as JSON, and as a report: for a terminal, or for a page with charts and the gain
/// of each candidate.
nlohmann::ordered_json traceJson(const terramech::TableTrace& trace);
Report traceReport(const terramech::TableTrace& trace, bool page);

}  // namespace talus::cli
