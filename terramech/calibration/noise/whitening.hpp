#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/moment_slip.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Slopes of the scaled predictions in the measured inputs slip and load, rows x kChannels.
struct InputSlopes {
  Eigen::MatrixXd by_slip;  ///< per unit of slip
  Eigen::MatrixXd by_load;  ///< per relative change of load; forces over the measured load
};
InputSlopes inputSlopes(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Covariance of one row's scaled residuals. `slip_variance` is absolute, `load_variance` relative.
Eigen::Matrix4d rowCovariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
                              const InputSlopes& slopes, const SensorNoise& noise, double slip_variance,
                              double load_variance);

/// Inverse of the lower Cholesky factor of a row's covariance; rows and columns of channels without a
/// measurement are zero.
Eigen::Matrix4d rowFactor(const Eigen::Matrix4d& covariance, const Eigen::MatrixXd& measured, int row);

/// One row of the residuals; 0 for missing measurements.
Eigen::Vector4d finiteOrZero(const Eigen::MatrixXd& residual, int row);

/// Transforms residuals to unit variance without correlation in three steps: rowFactor() of the covariance of
/// a row, then the slip error shared by rows of a moment, then the error shared by rows of a run.
struct Whitening {
  std::vector<Eigen::Matrix4d> factor;
  Eigen::MatrixXd std;   ///< marginal standard deviations of a row's independent error, rows x kChannels
  MomentSlip slip{};     ///< slip error shared by rows of a moment
  SharedError common{};  ///< error shared by rows of a run

  /// Returns the effect of each shared error component on every row of rowByRow(), after removal of the slip
  /// error of moments.
  std::vector<SharedFactor> shared() const;

  Eigen::VectorXd apply(const Eigen::MatrixXd& residual) const;     ///< rows*kChannels; 0 where missing
  Eigen::VectorXd rowByRow(const Eigen::MatrixXd& residual) const;  ///< without the shared errors of runs
  Eigen::VectorXd marginal(const Eigen::MatrixXd& residual) const;  ///< each value divided by its own std

 private:
  void settleRuns(Eigen::VectorXd& rows) const;
};
/// Whitening of the rows marked by `keep`.
Whitening subset(const Whitening& whitening, const std::vector<char>& keep);

/// Linearised effect of soil strength and stiffness on each row at the model's predictions; empty for a
/// drive, on which soil and slip vary together.
std::vector<SoilFactor> soilFactors(const RefinedModel& model, const Trial& trial,
                                    const Eigen::MatrixXd& level, const SolvedContacts& solved);

Whitening whitening(const Trial& trial, const Eigen::MatrixXd& level, const InputSlopes& slopes,
                    const SensorNoise& noise);

}  // namespace talus::terramech
