#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

/// The likelihood that tracing judges by: rows whitened each by itself, linear in the parameters about a fitted
/// model, with a Gaussian prior, and an error that rows of one run share.
namespace talus::terramech {

/// What parameters, as steps from where a model stands, are known to be beforehand: mean and 1 / variance, 0
/// for nothing.
struct StepPrior {
  Eigen::VectorXd mean, precision;
};

/// Derivatives of the whitened readings, rows*kChannels x parameters, and the prior of the steps.
struct LinearModel {
  Eigen::MatrixXd columns;
  StepPrior prior;
};

/// Sums over rows that the likelihood needs of columns X and of tables Y (whitened residuals, one a column).
struct RunSums {
  std::vector<Eigen::MatrixXd> gram;   ///< X^T X, a fold
  std::vector<Eigen::MatrixXd> cross;  ///< X^T Y, a fold
  Eigen::MatrixXd unit_column;         ///< sum of F^T X, a unit: kShared x parameters, one below the other
  StepPrior prior;
};

/// Parameters of each table, and how well those of the other folds predict each fold.
struct HeldOutFit {
  /// Sum over folds of ln p(rows of the fold | rows of the others, prior), less the constant that all models share: the
  /// predictive density, in which a parameter that the other folds do not determine has its prior.
  Eigen::VectorXd log_likelihood;
  /// Of each parameter the least among the fits without one fold each: of what one fold alone determines none.
  Eigen::VectorXd prior_chi2;
  Eigen::MatrixXd steps;  ///< those parameters, parameters x tables
  /// log_likelihood - prior_chi2 / 2 (T34): no prior counts twice, and a soil that returns to its prior gains.
  Eigen::VectorXd score() const { return log_likelihood - 0.5 * prior_chi2; }
};

/// Covariance of a table's residuals Y = X step + e + F u: e independent of unit variance, F what
/// an error that rows share does to a whitened row, u ~ N(0, R) once a unit.
class RunLikelihood {
 public:
  /// `factor`: F of each row; `unit`: number of its run from 0, empty where rows share nothing. Rows of a
  /// unit in different folds count as different units.
  RunLikelihood(const std::vector<SharedFactor>& factor, const std::vector<int>& unit, const Folds& folds);

  /// Takes the tables that are judged, whitened residuals rows*kChannels x tables.
  void setTables(const Eigen::MatrixXd& tables);

  RunSums sums(const LinearModel& model) const;

  /// Those of the columns of both models, at the price of the second's alone. `known` and `added` as given to
  /// sums(), `of_known` its result.
  RunSums sums(const RunSums& of_known, const LinearModel& known, const LinearModel& added) const;

  /// Each fold predicted from the others, for `count` tables from `first` on.
  HeldOutFit heldOut(const RunSums& sums, const RunError& run, Eigen::Index first, Eigen::Index count) const;

  /// Covariance R of a unit's error that is most likely with these columns in the model, among those in which
  /// strength and stiffness vary on their own: expectation maximisation of the restricted likelihood
  /// (laird_ware_1982) from `start`.
  RunError profile(const RunSums& sums, RunError start, Eigen::Index table, int steps) const;

  bool hasUnits() const { return !information_.empty(); }
  int folds() const { return folds_; }

  /// Logarithm of the likelihood of a table under no parameters at all, for choosing units.
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
  std::vector<RunError> information_;    ///< sum of F^T F, a unit
  std::vector<Eigen::MatrixXd> tables_;  ///< rows of each fold
  Eigen::MatrixXd square_;               ///< folds x tables
  Eigen::MatrixXd unit_table_;           ///< sum of F^T Y, a unit: kShared x tables, one below the other
};

}  // namespace talus::terramech
