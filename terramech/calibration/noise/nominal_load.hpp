#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Loads that a campaign sets: one for each run, or a few levels. How far the readings about them are error shows in
/// the contact: where a reading of the load moves and sinkage, torque and pull do not follow it as the model does, it was
/// the reading that erred. No size of the sensor's error need be known for that.
struct NominalLoad {
  Eigen::VectorXd log_mean;  ///< of each row's set load, ln N
  Eigen::VectorXd rows;      ///< that share it
  double error_share = 1.0;  ///< of the readings' deviation from the set load [-], (0, 1]
  double scatter = 0.0;      ///< of those deviations, relative

  double errorStd() const;  ///< of a reading, relative
  /// The true load of a row given its reading [N].
  double load_N(int row, double measured_N) const;
};

/// The set loads of a trial, `residual` measured - model at the inputs as measured, `slopes` there. The share is the
/// coefficient of -by_load d in the residual, both centred within the set loads, d = ln(reading / set load): 1 where the load
/// was as set, 0 where it was as read (least squares, channels weighed by their scatter; ours). None where loads follow neither
/// runs nor levels, of a drive, where the share is not known to a quarter, or not told from 0 by two standard errors.
std::optional<NominalLoad> nominalLoad(const Trial& trial, const Eigen::MatrixXd& residual,
                                       const InputSlopes& slopes);

}  // namespace talus::terramech
