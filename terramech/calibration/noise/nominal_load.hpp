#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Nominal loads of a test campaign: one load per run, or a few load levels. A load reading deviates from the
/// nominal load because of the reading error or because the true load deviates. The share of the reading
/// error follows from the other channels: a deviation without the change of sinkage, torque and pull that the
/// model predicts is a reading error. The standard deviation of the load sensor need not be known.
struct NominalLoad {
  Eigen::VectorXd log_mean;  ///< logarithm of the nominal load [N] of each row
  Eigen::VectorXd rows;      ///< number of rows that have the nominal load of this row
  /// Share of the reading error in the deviation from the nominal load [-], (0, 1].
  double error_share = 1.0;
  double scatter = 0.0;  ///< relative scatter of the readings about the nominal load [-]

  double errorStd() const;  ///< returns the relative standard deviation of a load reading [-]
  /// Returns the estimated true load of a row [N] from its reading.
  double load_N(int row, double measured_N) const;
};

/// Returns the nominal loads of a trial. `residual` is measured - model at the measured inputs, and `slopes`
/// contains the model's derivatives at these inputs. With d = ln(reading / nominal load), the error share is
/// the coefficient of -by_load d in the residual, both centred within the rows of each nominal load: 1 if the
/// true load was nominal, 0 if the true load was as read (least squares, channels weighted by their scatter;
/// ours). A share within two standard errors of 1 is set to 1. Returns nullopt for a rover's own drive, if
/// loads follow neither runs nor levels, if the share has a standard error above 0.25, or if the share does
/// not exceed 0 by two standard errors.
std::optional<NominalLoad> nominalLoad(const Trial& trial, const Eigen::MatrixXd& residual,
                                       const InputSlopes& slopes);

}  // namespace talus::terramech
