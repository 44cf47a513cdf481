#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

/// Likelihood for residual tracing. Rows are whitened separately, and the model is linear in its parameters
/// about a fitted model. The parameters have a Gaussian prior, and the rows of a run share an error.
namespace talus::terramech {

/// Folds: a partition of the rows into groups. The rows of a fold are held out together.
struct Folds {
  std::string scheme;       ///< description, for example "whole runs, five folds"
  std::vector<int> of_row;  ///< fold number of each row, from 0
  int count = 0;            ///< number of folds; 0: no partition
};

/// Returns five folds of whole runs. If the rows have no runs, the folds consist of whole levels (rows of one
/// value) or bands of slip, or of load if slip is constant. Rows of one run are never in different folds.
Folds foldsOf(const Trial& trial);

/// Returns folds of whole levels (rows with the same value) of a numeric column. There is one fold per level
/// for at most eight levels, otherwise ten bands in five folds. Returns no folds if there are fewer than
/// three levels of four rows.
Folds levelFolds(const Trial& trial, const std::string& column);

/// Marks the rows of a fold if `held` is true, otherwise the rows of all other folds.
std::vector<char> rowsOf(const Folds& folds, int fold, bool held);

/// Gaussian prior of the parameter steps (changes from the model's current values): mean and precision = 1 /
/// variance. A precision of 0 means no prior.
struct StepPrior {
  Eigen::VectorXd mean, precision;
};

/// Derivatives of the whitened readings with respect to the parameters, rows*kChannels x parameters, with the
/// prior of the parameter steps.
struct LinearModel {
  Eigen::MatrixXd columns;
  StepPrior prior;
};

/// Sums over rows of products of the derivatives X and the tables Y. Each column of Y is one table of
/// whitened residuals. A fold is a group of rows held out together; a unit is a group of rows (such as a run)
/// that share an error.
struct RunSums {
  std::vector<Eigen::MatrixXd> gram;   ///< X^T X of each fold
  std::vector<Eigen::MatrixXd> cross;  ///< X^T Y of each fold
  /// Sum of F^T X of each unit, kShared x parameters, stacked; F: see RunLikelihood.
  Eigen::MatrixXd unit_column;
  StepPrior prior;
};

/// Fitted parameter steps for each table, and the likelihood of each fold (held-out group of rows) under the
/// fit to the other folds.
struct HeldOutFit {
  /// Predictive density: the sum over folds of ln p(rows of the fold | rows of the other folds, prior),
  /// without the constant that is common to all models. A parameter that the other folds do not determine has
  /// its prior.
  Eigen::VectorXd log_likelihood;
  /// Squared deviation of the parameters from their priors. The value of each parameter is the least among
  /// the fits to all rows and the fits without one fold, so that a deviation that a single fold determines
  /// does not count.
  Eigen::VectorXd prior_chi2;
  Eigen::MatrixXd steps;  ///< steps fitted to all rows, parameters x tables
  /// Returns the score log_likelihood - prior_chi2 / 2 (T34). Each prior counts once; of two models with
  /// equal log_likelihood, the one with a soil closer to its prior has the higher score.
  Eigen::VectorXd score() const { return log_likelihood - 0.5 * prior_chi2; }
};

/// Likelihood of residuals Y = X step + e + F u. The errors e are independent with unit variance. F is the
/// effect of the shared error components on a whitened row. The components u ~ N(0, R) of each unit (group of
/// rows that share an error) are independent of other units.
class RunLikelihood {
 public:
  /// `factor` contains F of each row, and `unit` the number of each row's unit from 0; empty: rows share no
  /// error. Rows of a unit in different folds count as different units.
  RunLikelihood(const std::vector<SharedFactor>& factor, const std::vector<int>& unit, const Folds& folds);

  /// Sets the tables of whitened residuals, (rows * kChannels) x tables.
  void setTables(const Eigen::MatrixXd& tables);

  /// Returns the sums for the columns of a model.
  RunSums sums(const LinearModel& model) const;

  /// Returns the sums for the columns of `known` and `added` together, at the cost of the sums for `added`
  /// alone. `of_known` contains the sums for `known`.
  RunSums sums(const RunSums& of_known, const LinearModel& known, const LinearModel& added) const;

  /// Predicts each fold from the other folds, for `count` tables beginning with table `first`.
  HeldOutFit heldOut(const RunSums& sums, const RunError& run, Eigen::Index first, Eigen::Index count) const;

  /// Returns the most likely covariance R of a unit's error for one table, with the columns of `sums` in the
  /// model. Soil strength and stiffness are uncorrelated with the other components. The method is expectation
  /// maximisation of the restricted likelihood (laird_ware_1982), `steps` steps from `start`.
  RunError profile(const RunSums& sums, RunError start, Eigen::Index table, int steps) const;

  int folds() const { return folds_; }

  /// Returns the log-likelihood of a table for a model without parameters. The choice of units uses this
  /// value.
  double logLikelihood(const RunError& run, Eigen::Index table) const;

 private:
  struct FoldSums;
  static FoldSums together(const std::vector<FoldSums>& fold);
  std::vector<FoldSums> underRun(const RunSums& sums, const RunError& run, Eigen::Index first,
                                 Eigen::Index count) const;
  RunError shrink(std::size_t unit, const RunError& run) const;

  std::vector<SharedFactor> factor_;
  std::vector<int> unit_, fold_, fold_of_unit_;
  int folds_;
  std::vector<RunError> information_;    ///< sum of F^T F of each unit
  std::vector<Eigen::MatrixXd> tables_;  ///< tables, as rows of each fold
  Eigen::MatrixXd square_;               ///< folds x tables
  Eigen::MatrixXd unit_table_;           ///< sum of F^T Y of each unit, kShared x tables, stacked
};

/// Contender: a candidate for addition to a model, linearised about the fitted model.
struct Contender {
  LinearModel added;       ///< derivatives of the candidate's parameters, with their priors
  bool positive = false;   ///< true: the first parameter step must be >= 0
  double log_prior = 0.0;  ///< logarithm of the prior probability, a part of the gain
};

/// Number of contenders for which the run error (error shared by the rows of a run) is re-estimated in a
/// drawn table. The selected contenders are those of greatest gain under the null model's run error. The
/// contender of greatest gain is practically always among these twelve, and the cost remains that of matrix
/// products.
inline constexpr int kProfiled = 12;

/// Gain of every contender (candidate effect of this round) on the measured table, and greatest gains on tables drawn from the null model (the
/// current model without contenders).
struct GainDistribution {
  std::vector<double> gain;      ///< gain of each contender, in their order
  std::vector<double> greatest;  ///< greatest gain on each drawn table, ascending
  /// Score of the measured table under the null model: held-out log-likelihood plus prior term.
  double null_score = 0.0;
  RunError run = RunError::Zero();  ///< covariance of a run's error under the null model
  /// Logarithm of the ratio of the number of tests on the measured table to that on a drawn table. A
  /// log-likelihood ratio of noise exceeds x with a probability of order e^-x (Wilks). With N times as many
  /// tests, the greatest gain exceeds x + ln N with about the same probability (Bonferroni).
  double further_questions = 0.0;

  /// Returns the gain that the greatest gain on a drawn table exceeds with probability `level`.
  double threshold(double level) const;
  /// Returns the share of tables whose greatest gain is at least `reached`. The measured table counts as one
  /// of the tables, so that the share is at least 1 / (draws + 1).
  double pValue(double reached) const;
};

/// Null model, the reference of the gains: the current model, linearised on whitened rows.
struct NullModel {
  std::vector<SharedFactor> factor;  ///< effect of the error components shared by a run on each row
  std::vector<int> unit;             ///< run number of each row, from 0; empty: rows share no error
  Folds folds;                       ///< groups of rows that are held out together
  Eigen::VectorXd residual;          ///< whitened residuals, rows*kChannels
  LinearModel known;                 ///< derivatives with respect to the free parameters, with their priors
  RunError run_start;                ///< initial covariance of a run's error
  Eigen::Index soil = 0;             ///< number of leading columns of `known` that belong to the soil
};

/// Contenders by index. Each contender is requested once.
struct Contenders {
  std::size_t count = 0;
  std::function<Contender(std::size_t)> at;
};

/// Computes the gains of contenders on the measured table and on drawn tables. The gain of a contender is the
/// increase of the held-out log-likelihood when the contender is added to the null model, plus the change of
/// the prior term of the other parameters. The covariance of a run's error is estimated under both models. A
/// drawn table consists of the null model with a soil drawn from its prior, errors of unit variance, and
/// errors of runs with the estimated covariance. The soil is drawn because the fitted soil may be unrealistic
/// if an effect is missing. `go_on` receives the completed share; after a return value of false the remaining
/// gains are 0.
GainDistribution gainDistribution(const NullModel& null, const Contenders& contenders, int draws,
                                  std::uint64_t seed, const std::function<bool(double)>& go_on);

/// Returns the maximum-likelihood covariance of a run's error under a model.
RunError runErrorOf(const NullModel& null);

/// Returns the score of a fitted model, comparable to GainDistribution::null_score, from its residuals and
/// derivatives. The covariance of a run's error is re-estimated, starting from fitted.run_start.
double fittedScore(const NullModel& fitted);

/// Returns the unit number of each row, from 0. The rows of a unit share an error. Units are whole runs, or
/// stretches of 16, 8 or 4 rows of a run in order of time. The choice is that of maximum likelihood for the
/// residuals `left` (rows x kChannels, without their smooth dependence on columns); stretches must be more
/// likely by a factor of at least twenty. On a rover's own drive, units are moments (rows of all wheels at
/// one time). Stretches are not used without a time column, or if slip, load or similar columns depend on
/// time (except on a drive). Returns an empty vector without runs and stretches.
std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left);

/// Returns in every row and channel the mean of the row's unit, weighted by 1 / std^2. NaN values are ignored
/// and become 0.
Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit);

/// Returns an initial covariance of a run's error for a search: independent components of the size of a row's
/// error.
RunError roughRunError(const Whitening& whitening);

}  // namespace talus::terramech
