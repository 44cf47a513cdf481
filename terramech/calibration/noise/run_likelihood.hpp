#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

/// Likelihood for residual tracing. Rows are whitened separately, and the model is linear in its parameters
/// about a fitted model. The parameters have a Gaussian prior, and the rows of a run share an error.
namespace talus::terramech {

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

  bool hasUnits() const { return !information_.empty(); }
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

}  // namespace talus::terramech
