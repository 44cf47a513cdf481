#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Maximum a posteriori noise of sensors and inputs from what is left of the residuals once every smooth
/// dependence on a covariate is taken out (so that a missing effect does not pass for noise). Errors of slip
/// and load show as deviations that move all channels along `slopes` together. Stated standard deviations are
/// priors of 25 %, others are 3 % within a factor 2. `level` is the model's reading, for the relative parts.
SensorNoise fitNoise(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const StatedSensors& stated);

/// Sensors that by the fitted noise err far more than is stated of them: by more than two standard deviations of that
/// statement's own uncertainty, e^0.5. `noise` is left as it would be if they erred as stated.
std::vector<StrainedSensor> strainedSensors(const Trial& trial, const Eigen::MatrixXd& level,
                                            const StatedSensors& stated, SensorNoise& noise);

/// Columns that are measured and of whose error nothing is stated.
std::vector<std::string> unstatedSensors(const Trial& trial, const StatedSensors& stated);

/// Residuals with an additive smooth of these columns taken out, scaled up for the freedom that it took. NaN
/// stay.
Eigen::MatrixXd withoutSmooth(const Trial& trial, const Eigen::MatrixXd& residual,
                              const std::vector<std::string>& columns);

/// The covariates of a trial that the noise may be smoothed over: those chosen for their link to the residuals though
/// it seems to be by chance would take a part of the noise with them.
std::vector<std::string> noiseColumns(const Trial& trial);

/// Those that do not determine its slip.
std::vector<std::string> allButSlip(const Trial& trial);

}  // namespace talus::terramech
