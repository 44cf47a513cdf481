#pragma once

#include <vector>

#include <Eigen/Core>

/// Slip error that the rows of a moment share. A moment is the set of rows of all wheels of a rover at one
/// time. All wheels have the same turning rate, and the slip is measured once per moment.
namespace talus::terramech {

/// Effect of the shared slip error on rows that are otherwise independent with unit variance. Within each
/// moment the covariance of the rows is I + u u^T. Empty if rows share no slip error.
struct MomentSlip {
  std::vector<int> moment;  ///< moment number of each row, from 0
  /// u, rows x channels: change of the whitened readings for one standard deviation of the slip error.
  Eigen::MatrixXd moved;

  /// Decorrelates the rows (channels of a row adjacent) by multiplication with (I + u u^T)^(-1/2) of each
  /// moment.
  void takeOut(Eigen::Ref<Eigen::VectorXd> rows) const;

  /// Returns the log-likelihood of the rows minus that of independent rows (Sherman-Morrison).
  double logLikelihood(const Eigen::VectorXd& rows) const;
};

/// Returns the MomentSlip of the rows marked by `keep`.
MomentSlip subset(const MomentSlip& slip, const std::vector<char>& keep);

}  // namespace talus::terramech
