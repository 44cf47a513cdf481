#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Returns the maximum a posteriori noise of sensors and inputs. Residuals are used without their smooth
/// dependence on covariates, so that a missing effect does not increase the noise. Errors of slip and load
/// are deviations that move all channels together along `slopes`. Stated standard deviations are priors with
/// 25 % uncertainty; other standard deviations have the prior 3 % within a factor of 2. `level` contains the
/// model's predictions, for relative errors.
SensorNoise fitNoise(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const StatedSensors& stated);

/// Sensors whose fitted noise exceeds the stated noise by a factor above e^0.5, two standard deviations of
/// the uncertainty of a statement. Sets these sensors in `noise` to the stated values.
std::vector<StrainedSensor> strainedSensors(const Trial& trial, const Eigen::MatrixXd& level,
                                            const StatedSensors& stated, SensorNoise& noise);

/// Measured columns without a stated error.
std::vector<std::string> unstatedSensors(const Trial& trial, const StatedSensors& stated);

/// Residuals without an additive smooth of the columns, scaled up for the degrees of freedom of the smooth.
/// NaN values remain.
Eigen::MatrixXd withoutSmooth(const Trial& trial, const Eigen::MatrixXd& residual,
                              const std::vector<std::string>& columns);

/// Covariates of a trial used for smooths in the noise fit. Covariates that a screening kept without
/// significance (Trial::chance) are excluded, because their smooths would absorb a part of the noise.
std::vector<std::string> noiseColumns(const Trial& trial);

/// The noise covariates that do not determine the slip.
std::vector<std::string> allButSlip(const Trial& trial);

}  // namespace talus::terramech
