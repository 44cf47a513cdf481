#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>

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

/// Derivatives of the predicted scaled channels with respect to the measured inputs slip and load, rows x
/// kChannels.
struct InputSlopes {
  Eigen::MatrixXd by_slip;  ///< per unit of slip
  Eigen::MatrixXd by_load;  ///< per relative change of load, with forces divided by the measured load
};
/// Returns the derivatives of a model's predictions on the rows of a trial.
InputSlopes inputSlopes(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Returns the covariance of one row's scaled residuals. `level` contains the model's predictions;
/// `slip_variance` is absolute, `load_variance` relative.
Eigen::Matrix4d rowCovariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
                              const InputSlopes& slopes, const SensorNoise& noise, double slip_variance,
                              double load_variance);

/// Returns the inverse of the lower Cholesky factor of a row's covariance. Its rows and columns of channels
/// without a measurement are zero.
Eigen::Matrix4d rowFactor(const Eigen::Matrix4d& covariance, const Eigen::MatrixXd& measured, int row);

/// Returns one row of the residuals, with 0 for missing measurements.
Eigen::Vector4d finiteOrZero(const Eigen::MatrixXd& residual, int row);

/// Transformation of residuals to uncorrelated values of unit variance. The transformation removes in turn
/// the covariance of the channels of a row (rowFactor()), the slip error shared by the rows of a moment (all
/// wheels at one time), and the error shared by the rows of a run.
struct Whitening {
  std::vector<Eigen::Matrix4d> factor;  ///< rowFactor() of each row
  Eigen::MatrixXd std;   ///< standard deviations of each row's independent errors, rows x kChannels
  MomentSlip slip{};     ///< slip error shared by the rows of a moment
  SharedError common{};  ///< error shared by the rows of a run

  /// Returns the effect of each component of the error shared by a run on every row of rowByRow(), after
  /// removal of the slip error of moments.
  std::vector<SharedFactor> shared() const;

  /// Whitened residuals, rows*kChannels; 0 where missing.
  Eigen::VectorXd apply(const Eigen::MatrixXd& residual) const;
  /// Residuals whitened by apply(), but without removal of the error shared by a run.
  Eigen::VectorXd rowByRow(const Eigen::MatrixXd& residual) const;
  /// Each residual divided by its own standard deviation.
  Eigen::VectorXd marginal(const Eigen::MatrixXd& residual) const;

 private:
  void settleRuns(Eigen::VectorXd& rows) const;
};
/// Returns the whitening of the rows marked by `keep`.
Whitening subset(const Whitening& whitening, const std::vector<char>& keep);

/// Returns the linearised effect of soil strength and stiffness on each row, at the model's predictions
/// `level`. Returns an empty vector for a rover's own drive, on which soil and slip vary together.
std::vector<SoilFactor> soilFactors(const RefinedModel& model, const Trial& trial,
                                    const Eigen::MatrixXd& level, const SolvedContacts& solved);

/// Returns the whitening of a trial at the model's predictions `level`, for the given sensor errors.
Whitening whitening(const Trial& trial, const Eigen::MatrixXd& level, const InputSlopes& slopes,
                    const SensorNoise& noise);

}  // namespace talus::terramech
