#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Nominal loads of a campaign: one per run, or a few levels. The share of reading error in the deviations
/// from the nominal load follows from the other channels: a deviation of the load reading without the change
/// of sinkage, torque and pull that the model predicts is a reading error. The standard deviation of the
/// sensor need not be known.
struct NominalLoad {
  Eigen::VectorXd log_mean;  ///< nominal load of each row, ln N
  Eigen::VectorXd rows;      ///< number of rows with this nominal load
  double error_share = 1.0;  ///< share of reading error in the deviation from the nominal load [-], (0, 1]
  double scatter = 0.0;      ///< relative scatter of these deviations

  double errorStd() const;  ///< relative standard deviation of a load reading [-]
  /// Estimated true load of a row from its reading [N].
  double load_N(int row, double measured_N) const;
};

/// Nominal loads of a trial. `residual` is measured - model at the measured inputs, `slopes` the model's
/// derivatives at these inputs. The error share is the coefficient of -by_load d in the residual, both
/// centred within the nominal loads, with d = ln(reading / nominal load): 1 if the true load was nominal, 0
/// if the true load was as read (least squares, channels weighted by their scatter; ours). A share within two
/// standard errors of 1 is set to 1. Returns nullopt if loads follow neither runs nor levels, for a drive, if
/// the share has a standard error above 0.25, or if the share does not exceed 0 by two standard errors.
std::optional<NominalLoad> nominalLoad(const Trial& trial, const Eigen::MatrixXd& residual,
                                       const InputSlopes& slopes);

}  // namespace talus::terramech
