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

/// How residuals are traced.
struct TraceOptions {
  double significance = 0.05;  ///< share of tables without an effect in which one may be found
  int max_effects = 7;
  double least_share = 0.0;  ///< chi-squared a value that an effect must carry
  int fits = 6;              ///< known forms that are fitted inside the full model, a round; of curves half
  int draws = 199;           ///< tables drawn from the null: p-values from 0.005 on
  /// Rows that are searched, of a table with more a sample (rowSample()): beyond it nothing but time is gained, as an
  /// effect of a tenth of the scatter of single readings stands at 3 standard errors of a thousand.
  int most_rows = 1000;
  int most_columns =
      24;  ///< columns of one's own that are searched, of more the most promising (screenColumns())
  bool fit_soil = false;  ///< the base soil is not given: it is fitted from the data
  std::uint64_t seed = 1;
};

/// A candidate that was fitted, and how well.
struct Explanation {
  Candidate candidate;  ///< with fitted parameters
  /// log-likelihood gained on held-out rows, with the share of the soil's prior that it regains.
  double gain = 0.0;
  double chi2_gain = 0.0;  ///< twice the log-likelihood gained on the rows that it was fitted to
  std::array<double, kChannels> by_channel{};  ///< chi2 gained in each channel
};

/// A candidate tried to first order.
struct Promise {
  Candidate candidate;
  double gain = 0.0;     ///< as Explanation's
  double p_value = 1.0;  ///< how often a table without an effect gives any candidate this gain
};

/// Root mean square of the scaled residual in each channel; NaN where nothing is measured.
using ChannelErrors = std::array<double, kChannels>;

/// Log-likelihood by which one account must fall behind to be ruled out: as unlikely beside the other as `significance`.
inline double closeGain(const TraceOptions& options) {
  return -std::log(options.significance);
}

/// An effect that was found.
struct TracedEffect {
  Explanation chosen;
  Channel channel = Channel::DrawbarPull;  ///< where it shows most
  std::vector<double> parameter_std;       ///< of the fitted model's parameters of chosen.candidate, in order
  double p_value = 1.0;                    ///< how often a table without it gives any candidate its gain
  /// Other causes that the rows cannot separate from it: in its place each gains no less, or less by no more than
  /// closeGain(), best first.
  std::vector<Explanation> equal;
  std::vector<Effect> correction;  ///< curves that carry what its form leaves in the same covariate
};

/// Another cause, and the model with it.
struct RivalCause {
  std::string in_place_of;  ///< name of the traced effect; empty: beside those that there are
  Explanation explanation;
  RefinedModel model;  ///< with the covariance of its parameters
};

/// The outermost rows of a column, predicted by a model that was fitted to the others.
struct EndLevel {
  std::string column;
  bool high = false;      ///< the greatest values, else the least
  double edge = 0.0;      ///< outermost value of the others
  double distance = 0.0;  ///< of the held rows from it, root mean square
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
  bool law = false;  ///< an effect of this column foretold the level better by its law than held at `edge`
  /// Of each effect of the refined model how far from `edge` it did: the farthest of these rows. 0 where it did not, or
  /// is of another column.
  std::vector<double> reach{};
};

/// Errors on rows of one group of a text column, the fit made from all groups.
struct GroupErrors {
  std::string column, value;
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Errors on rows that the fit has not seen. The parameters are fitted again without each fold; which effects
/// the model has was chosen on all rows.
struct HeldOut {
  std::string scheme;         ///< what was held out together
  ChannelErrors base_rmse{};  ///< of the base model, its soil fitted again where it was fitted
  ChannelErrors refined_rmse{};
  std::vector<GroupErrors> groups;  ///< of each text column of which an effect acts on one group alone
};

/// Errors on the rows of a large table that the search did not use.
struct UnsearchedRows {
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// What tracing found.
struct TraceResult {
  Soil given;            ///< of the base, before any fit
  RefinedModel base;     ///< as given or fitted, with its noise
  RefinedModel refined;  ///< base and the effects
  Trial trial;           ///< the rows that were searched, inputs calibrated
  UnsearchedRows unsearched;
  std::vector<TracedEffect> effects;
  std::vector<RivalCause> rivals;     ///< of each effect the next best, of no effect what was rejected
  std::vector<Explanation> rejected;  ///< fitted and not chosen in the last round, or less likely than noise
  std::vector<Promise> first_promises, last_promises;  ///< of base and refined model, best first
  double threshold = 0.0;                              ///< gain that noise reaches in a share `significance`
  ChannelErrors base_rmse{}, refined_rmse{}, noise_floor{};
  std::vector<StrainedSensor> strained;  ///< beside the refined model
  ChannelErrors declared_floor{};        ///< noise_floor if these sensors erred as stated
  std::optional<Estimate>
      first_prior;  ///< of the first number of the first effect found, known beside the model
  SharedError base_shared,
      shared;  ///< what the rows of a run have in common beside the base, and the refined model
  std::vector<EndLevel> ends;  ///< of the model beyond its rows
  HeldOut held_out;            ///< under foldsOf()
  ModelScope scope;            ///< where held-out rows confirmed the effects
};

/// Root mean square of the residuals (measured - predicted), scaled.
ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial);
ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial);

}  // namespace talus::terramech
