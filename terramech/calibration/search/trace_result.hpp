#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/fit/candidate.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::terramech {

/// Options of residual tracing: the search for effects that explain the residuals of a wheel model.
struct TraceOptions {
  double significance = 0.05;  ///< probability of finding an effect in a table without effects, (0, 1)
  int max_effects = 7;         ///< greatest number of effects that are found
  double least_share = 0.0;    ///< least reduction of chi-squared per measured value by an effect [-]
  /// Number of candidate library effects that are fitted in the full model per round; for curves (empirical
  /// functions of a column) half this number.
  int fits = 6;
  /// Number of random tables drawn from the current model with noise alone; the least p-value is 1 / (draws +
  /// 1).
  int draws = 199;
  /// Greatest number of rows that are searched; of a larger table a sample is searched (rowSample()). A
  /// thousand rows suffice: an effect of a tenth of the scatter of single readings then has 3 standard
  /// errors.
  int most_rows = 1000;
  /// Greatest number of additional columns (unknown to Talus) that are searched; screenColumns() selects
  /// them.
  int most_columns = 24;
  bool fit_soil = false;   ///< true: the soil of the base model is fitted to the data, with vague priors
  std::uint64_t seed = 1;  ///< seed of the random numbers
};

/// Explanation: a fitted candidate (possible addition to a model) and its gain.
struct Explanation {
  Candidate candidate;  ///< candidate with fitted parameters
  /// Increase of the log-likelihood on held-out rows, including the change of the prior term of the soil and
  /// the logarithm of the candidate's prior [-].
  double gain = 0.0;
  /// Returns the gain without the candidate's prior.
  double evidence() const { return gain - candidate.logPrior(); }
  double chi2_gain = 0.0;  ///< twice the increase of the log-likelihood on the fitted rows [-]
};

/// Promise: a candidate before its fit, with its linearised gain.
struct Promise {
  Candidate candidate;
  double gain = 0.0;  ///< linearised value of Explanation::gain
  /// Probability that any candidate has at least this gain in a table without an effect.
  double p_value = 1.0;
};

/// Root mean square of the scaled residual in each channel [-]; NaN for a channel that is not measured.
using ChannelErrors = std::array<double, kChannels>;

/// Returns the deficit of log-likelihood above which an explanation is excluded in favour of a better one:
/// -ln(significance).
inline double closeGain(const TraceOptions& options) {
  return -std::log(options.significance);
}

/// Effect that the search accepted.
struct TracedEffect {
  Explanation chosen;                      ///< effect, as a fitted candidate
  Channel channel = Channel::DrawbarPull;  ///< channel in which the effect is largest
  std::vector<double> parameter_std;  ///< standard deviation of each fitted parameter of chosen.candidate
  double p_value = 1.0;               ///< probability of at least this gain in a table without the effect
  /// Other causes that the rows cannot distinguish from the effect, best first. In place of the effect, each
  /// has a gain of at least that of the effect minus closeGain().
  std::vector<Explanation> equal;
};

/// Alternative cause, with the model that contains this cause.
struct RivalCause {
  std::string in_place_of;  ///< name of the replaced effect; empty: the cause is added to all effects
  Explanation explanation;
  RefinedModel model;  ///< model with this cause, and with the covariance of its parameters
};

/// End of a column: the rows with the outermost values, predicted by a model that was fitted to the other
/// rows.
struct EndLevel {
  std::string column;     ///< name of the column
  bool high = false;      ///< true: the rows with the greatest values; false: with the least
  double distance = 0.0;  ///< root mean square distance of the held-out rows from the other rows
  int rows = 0;           ///< number of held-out rows
  /// Errors of the base and of the refined model on these rows.
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Errors on held-out rows. The parameters are refitted without each fold (held-out group of rows); the
/// choice of effects used all rows.
struct HeldOut {
  std::string scheme;            ///< kind of rows that are held out together
  ChannelErrors base_rmse{};     ///< errors of the base model; a fitted soil is refitted
  ChannelErrors refined_rmse{};  ///< errors of the refined model
};

/// Errors on the rows of a large table that the search did not use.
struct UnsearchedRows {
  int rows = 0;  ///< number of these rows
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Result of residual tracing. The base model is the model whose residuals were traced.
struct TraceResult {
  Soil given;            ///< soil of the base model before any fit
  RefinedModel base;     ///< base model, fitted if it has free parameters, with its sensor noise
  RefinedModel refined;  ///< base model with the found effects, fitted
  Trial trial;           ///< searched rows, with estimated true slip and load
  UnsearchedRows unsearched;
  std::vector<TracedEffect> effects;  ///< found effects, in the order of acceptance
  /// Alternative causes of the effects; without effects, the best rejected explanations.
  std::vector<RivalCause> rivals;
  std::vector<Explanation> rejected;  ///< explanations that were fitted in the last round and not accepted
  /// Candidates for the base model and for the refined model, best first.
  std::vector<Promise> first_promises, last_promises;
  double threshold = 0.0;  ///< gain that noise exceeds with probability `significance`
  /// Errors of both models on the searched rows, and rms that the fitted sensor noise causes.
  ChannelErrors base_rmse{}, refined_rmse{}, noise_floor{};
  /// Sensors whose fitted noise under the refined model exceeds the stated noise.
  std::vector<StrainedSensor> strained;
  ChannelErrors declared_floor{};  ///< noise_floor with the stated errors of the sensors in `strained`
  /// Error common to the rows of a run, for the base model and for the refined model.
  SharedError base_shared, shared;
  std::vector<EndLevel> ends;  ///< errors at the ends of columns, for extrapolation
  HeldOut held_out;            ///< errors on held-out rows, for the folds of foldsOf()
  ModelScope scope;            ///< channels and ranges in which held-out rows confirmed the effects
};

/// Return the root mean square of measured minus predicted scaled channels [-].
ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial);
ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial);

}  // namespace talus::terramech
