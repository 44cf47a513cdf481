#pragma once

#include <vector>

#include <Eigen/Core>

/// All wheels of a rover have the same turning rate, and the slip is measured once per moment: rows of a
/// moment share the slip error.
namespace talus::terramech {

/// Effect of the shared slip error on otherwise independent rows of unit variance: within each moment the
/// covariance of the rows is I + u u^T. Empty if rows share no error.
struct MomentSlip {
  std::vector<int> moment;  ///< number of each row's moment, from 0
  Eigen::MatrixXd moved;    ///< u, rows x channels: change for one standard deviation of the slip error

  /// Decorrelates the rows (channels of a row adjacent) by (I + u u^T)^(-1/2) of each moment.
  void takeOut(Eigen::Ref<Eigen::VectorXd> rows) const;

  /// Log-likelihood of the rows minus that of independent rows (Sherman-Morrison).
  double logLikelihood(const Eigen::VectorXd& rows) const;
};

/// MomentSlip of the rows marked by `keep`.
MomentSlip subset(const MomentSlip& slip, const std::vector<char>& keep);

}  // namespace talus::terramech
