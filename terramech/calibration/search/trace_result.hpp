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

/// Options of residual tracing.
struct TraceOptions {
  double significance = 0.05;  ///< probability of finding an effect in a table without effects, (0, 1)
  int max_effects = 7;         ///< greatest number of effects
  double least_share = 0.0;    ///< least chi-squared per value that an effect must explain [-]
  int fits = 6;                ///< number of known forms fitted in the full model per round; curves: half
                               ///< this number
  int draws = 199;             ///< tables drawn from the null model: the least p-value is 1 / (draws + 1)
  /// Greatest number of rows that are searched; a larger table is sampled (rowSample()). A thousand rows
  /// suffice: an effect of a tenth of the scatter of single readings then has 3 standard errors.
  int most_rows = 1000;
  int most_columns =
      24;  ///< greatest number of additional columns that are searched, selected by screenColumns()
  bool fit_soil = false;  ///< fit the soil of the base to the data, with vague priors
  std::uint64_t seed = 1;
};

/// A fitted candidate and its gain.
struct Explanation {
  Candidate candidate;  ///< with fitted parameters
  /// Log-likelihood gained on held-out rows, including the regained share of the soil's prior [-].
  double gain = 0.0;
  double chi2_gain = 0.0;                      ///< twice the log-likelihood gained on the fitted rows [-]
  std::array<double, kChannels> by_channel{};  ///< chi-squared gained in each channel [-]
};

/// A candidate with its linearised gain.
struct Promise {
  Candidate candidate;
  double gain = 0.0;     ///< as Explanation::gain
  double p_value = 1.0;  ///< probability that any candidate reaches this gain in a table without an effect
};

/// Root mean square of the scaled residual in each channel [-]; NaN: not measured.
using ChannelErrors = std::array<double, kChannels>;

/// Log-likelihood deficit above which an explanation is excluded in favour of a better one:
/// -ln(significance).
inline double closeGain(const TraceOptions& options) {
  return -std::log(options.significance);
}

/// An accepted effect.
struct TracedEffect {
  Explanation chosen;
  Channel channel = Channel::DrawbarPull;  ///< channel in which the effect is largest
  std::vector<double> parameter_std;       ///< of the fitted parameters of chosen.candidate, in order
  double p_value = 1.0;                    ///< probability of its gain in a table without the effect
  /// Other causes that the rows cannot distinguish from the effect, best first. In place of the effect, each
  /// has a gain no lower than that of the effect minus closeGain().
  std::vector<Explanation> equal;
  std::vector<Effect> correction;  ///< curves of the same covariate for the remaining residual of the form
};

/// An alternative cause, and the model with this cause.
struct RivalCause {
  std::string in_place_of;  ///< name of the traced effect; empty: in addition to all effects
  Explanation explanation;
  RefinedModel model;  ///< with the covariance of its parameters
};

/// The outermost rows of a column, predicted by a model that was fitted to the other rows.
struct EndLevel {
  std::string column;
  bool high = false;      ///< true: the greatest values; false: the least
  double edge = 0.0;      ///< outermost value of the other rows
  double distance = 0.0;  ///< root mean square distance of the held-out rows from `edge`
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
  bool law = false;  ///< true if the formula of an effect of this column predicted the level better than
                     ///< its value at `edge`
  /// For each effect of the refined model, the distance from `edge` up to which its formula is confirmed: the
  /// distance of the farthest held-out row, or 0 if the formula is not confirmed or the effect is of another
  /// column.
  std::vector<double> reach{};
};

/// Errors on the rows of one group of a text column, for a fit to all groups.
struct GroupErrors {
  std::string column, value;  ///< text column, and value of the group
  int rows = 0;               ///< number of rows of the group
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Errors on held-out rows. The parameters are refitted without each fold; the choice of effects used all
/// rows.
struct HeldOut {
  std::string scheme;         ///< the kind of rows that are held out together
  ChannelErrors base_rmse{};  ///< errors of the base model, with refitted soil if the soil is fitted
  ChannelErrors refined_rmse{};
  std::vector<GroupErrors> groups;  ///< errors by group, for each text column with an effect on a single
                                    ///< group
};

/// Errors on the rows of a large table that the search did not use [-].
struct UnsearchedRows {
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Result of residual tracing.
struct TraceResult {
  Soil given;            ///< soil of the base before any fit
  RefinedModel base;     ///< the base, fitted if it has free parameters, with its noise
  RefinedModel refined;  ///< the base with the effects
  Trial trial;           ///< the searched rows, with calibrated inputs
  UnsearchedRows unsearched;
  std::vector<TracedEffect> effects;
  std::vector<RivalCause> rivals;     ///< best alternatives of each effect; without effects, the best
                                      ///< rejected explanations
  std::vector<Explanation> rejected;  ///< explanations fitted in the last round and not accepted
  std::vector<Promise> first_promises, last_promises;  ///< candidates for the base and for the refined model,
                                                       ///< best first
  double threshold = 0.0;                              ///< gain that noise exceeds at `significance`
  ChannelErrors base_rmse{}, refined_rmse{}, noise_floor{};
  std::vector<StrainedSensor> strained;  ///< sensors whose fitted noise for the refined model exceeds the
                                         ///< stated noise
  ChannelErrors declared_floor{};        ///< noise_floor with the stated errors of these sensors
  std::optional<Estimate> first_prior;   ///< external prior of the first parameter of the first effect found
  SharedError base_shared,
      shared;                  ///< error common to the rows of a run, for the base and for the refined model
  std::vector<EndLevel> ends;  ///< errors beyond the trained rows
  HeldOut held_out;            ///< errors on held-out rows, for the folds of foldsOf()
  ModelScope scope;            ///< channels and ranges in which held-out rows confirmed the effects
};

/// Root mean square of measured minus predicted values, scaled [-].
ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial);
ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial);

}  // namespace talus::terramech
