#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/moment_slip.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Slopes of the scaled readings in the two inputs that are themselves measured, rows x kChannels.
struct InputSlopes {
  Eigen::MatrixXd by_slip;  ///< per unit of slip
  Eigen::MatrixXd by_load;  ///< per relative change of load, forces over the measured load
};
InputSlopes inputSlopes(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Covariance of one row's scaled residuals. `slip_variance` absolute, `load_variance` relative.
Eigen::Matrix4d rowCovariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
                              const InputSlopes& slopes, const SensorNoise& noise, double slip_variance,
                              double load_variance);

/// Inverse of the lower Cholesky factor of a row's covariance, zero rows and columns for the channels that it
/// does not measure.
Eigen::Matrix4d rowFactor(const Eigen::Matrix4d& covariance, const Eigen::MatrixXd& measured, int row);

/// A row with 0 where nothing was measured.
Eigen::Vector4d finiteOrZero(const Eigen::MatrixXd& residual, int row);

/// Makes residuals of unit variance and uncorrelated: rowFactor() of their covariance; what rows of one
/// moment share of its slip's error taken out; then what rows of a run share.
struct Whitening {
  std::vector<Eigen::Matrix4d> factor;
  Eigen::MatrixXd std;   ///< marginal standard deviations of a row's own error, rows x kChannels
  MomentSlip slip{};     ///< error of the slip that rows of a moment share
  SharedError common{};  ///< what the rows of a run share

  /// What each part of an error that rows share becomes in each row of rowByRow(), less what the moments' slip
  /// takes out.
  std::vector<SharedFactor> shared() const;

  Eigen::VectorXd apply(const Eigen::MatrixXd& residual) const;     ///< rows*kChannels; 0 where missing
  Eigen::VectorXd rowByRow(const Eigen::MatrixXd& residual) const;  ///< the same without the runs' error
  Eigen::VectorXd marginal(const Eigen::MatrixXd& residual) const;  ///< each over its own std

 private:
  void settleRuns(Eigen::VectorXd& rows) const;
};
/// The rows that `keep` marks.
Whitening subset(const Whitening& whitening, const std::vector<char>& keep);

/// What strength and stiffness of the soil do to each row about a model's readings, to first order; nothing on a
/// drive, whose soil changes along the way as its slip does.
std::vector<SoilFactor> soilFactors(const RefinedModel& model, const Trial& trial,
                                    const Eigen::MatrixXd& level, const SolvedContacts& solved);

Whitening whitening(const Trial& trial, const Eigen::MatrixXd& level, const InputSlopes& slopes,
                    const SensorNoise& noise);

}  // namespace talus::terramech
