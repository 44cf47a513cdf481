#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

/// Likelihood for residual tracing: rows whitened separately, linear in the parameters about a fitted model,
/// with a Gaussian prior and an error common to the rows of a run.
namespace talus::terramech {

/// Prior of the parameters, as steps from the model's current values: mean and 1 / variance; precision 0: no
/// prior.
struct StepPrior {
  Eigen::VectorXd mean, precision;
};

/// Derivatives of the whitened readings, rows*kChannels x parameters, and the prior of the steps.
struct LinearModel {
  Eigen::MatrixXd columns;
  StepPrior prior;
};

/// Sums over rows of columns X and of tables Y (whitened residuals, one table per column).
struct RunSums {
  std::vector<Eigen::MatrixXd> gram;   ///< X^T X, per fold
  std::vector<Eigen::MatrixXd> cross;  ///< X^T Y, per fold
  Eigen::MatrixXd unit_column;         ///< sum of F^T X, per unit: kShared x parameters, stacked
  StepPrior prior;
};

/// Fitted steps of each table, and the likelihood of each fold under the fits to the other folds.
struct HeldOutFit {
  /// Sum over folds of ln p(rows of the fold | rows of the other folds, prior), without the constant common
  /// to all models: the predictive density. A parameter that the other folds do not determine has its prior.
  Eigen::VectorXd log_likelihood;
  /// Sum over parameters of the least squared departure from the prior among all fits with and without each
  /// fold: a departure that a single fold determines does not count.
  Eigen::VectorXd prior_chi2;
  Eigen::MatrixXd steps;  ///< fitted to all rows, parameters x tables
  /// log_likelihood - prior_chi2 / 2 (T34): each prior counts once, and a soil closer to its prior has a
  /// higher score.
  Eigen::VectorXd score() const { return log_likelihood - 0.5 * prior_chi2; }
};

/// Likelihood of residuals Y = X step + e + F u: e independent of unit variance, F the effect of a shared
/// error on a whitened row, u ~ N(0, R), one u per unit.
class RunLikelihood {
 public:
  /// `factor`: F of each row; `unit`: number of its run from 0, empty if rows share no error. Rows of a unit
  /// in different folds count as different units.
  RunLikelihood(const std::vector<SharedFactor>& factor, const std::vector<int>& unit, const Folds& folds);

  /// Sets the tables: whitened residuals, (rows * kChannels) x tables.
  void setTables(const Eigen::MatrixXd& tables);

  RunSums sums(const LinearModel& model) const;

  /// Returns the sums for the columns of `known` and `added` together, at the cost of those of `added`;
  /// `of_known` are the sums of `known`.
  RunSums sums(const RunSums& of_known, const LinearModel& known, const LinearModel& added) const;

  /// Predicts each fold from the other folds, for `count` tables from `first` on.
  HeldOutFit heldOut(const RunSums& sums, const RunError& run, Eigen::Index first, Eigen::Index count) const;

  /// Most likely covariance R of a unit's error with these columns in the model, with strength and stiffness
  /// uncorrelated with other components: expectation maximisation of the restricted likelihood
  /// (laird_ware_1982) from `start`.
  RunError profile(const RunSums& sums, RunError start, Eigen::Index table, int steps) const;

  bool hasUnits() const { return !information_.empty(); }
  int folds() const { return folds_; }

  /// Log-likelihood of a table without parameters, for the choice of units.
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
  std::vector<RunError> information_;    ///< sum of F^T F, per unit
  std::vector<Eigen::MatrixXd> tables_;  ///< rows of each fold
  Eigen::MatrixXd square_;               ///< folds x tables
  Eigen::MatrixXd unit_table_;           ///< sum of F^T Y, per unit: kShared x tables, stacked
};

}  // namespace talus::terramech
