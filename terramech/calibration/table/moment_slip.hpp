#pragma once

#include <vector>

#include <Eigen/Core>

/// All wheels of a rover turn at one rate and its slip is read once a moment: rows of a moment share the
/// error of that reading.
namespace talus::terramech {

/// What the shared error does to rows that are otherwise independent, of unit variance and uncorrelated:
/// their covariance is I + u u^T over each moment. Empty where rows share nothing.
struct MomentSlip {
  std::vector<int> moment;  ///< number of each row's moment, from 0
  Eigen::MatrixXd moved;    ///< u, rows x channels: by one standard deviation of the slip's error

  /// Makes rows, channels of a row side by side, independent of one another, too: (I + u u^T)^(-1/2) of each
  /// moment.
  void takeOut(Eigen::Ref<Eigen::VectorXd> rows) const;

  /// What the log-likelihood of such rows is more than were they independent (Sherman and Morrison).
  double logLikelihood(const Eigen::VectorXd& rows) const;
};

/// The rows that `keep` marks.
MomentSlip subset(const MomentSlip& slip, const std::vector<char>& keep);

}  // namespace talus::terramech
