#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// Returns the maximum a posteriori standard deviations of the sensors, including those of slip and load. The
/// smooth dependence of the residuals on covariates is removed first, so that a missing effect does not
/// increase the noise. Errors of slip and load are deviations that change all channels together along
/// `slopes`. A stated standard deviation is a prior with 25 % uncertainty; other standard deviations have the
/// prior 3 % within a factor of 2. `level` contains the model's predictions, for relative errors.
SensorNoise fitNoise(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const StatedSensors& stated);

/// Returns the sensors whose fitted noise exceeds the stated noise by a factor above e^0.5, i.e. by two
/// standard deviations of the uncertainty of a stated value. Sets these sensors in `noise` to the stated
/// values. `level` contains the model's predictions.
std::vector<StrainedSensor> strainedSensors(const Trial& trial, const Eigen::MatrixXd& level,
                                            const StatedSensors& stated, SensorNoise& noise);

/// Returns the measured columns whose sensor error is not stated.
std::vector<std::string> unstatedSensors(const Trial& trial, const StatedSensors& stated);

/// Returns the residuals after subtraction of a sum of smooth functions of the columns, scaled up for the
/// degrees of freedom of these functions. NaN values remain.
Eigen::MatrixXd withoutSmooth(const Trial& trial, const Eigen::MatrixXd& residual,
                              const std::vector<std::string>& columns);

/// Returns the covariates of a trial (columns that vary) for smooth functions in the noise fit. Covariates
/// that a screening kept without significance (Trial::chance) are excluded, because their smooth functions
/// would absorb a part of the noise.
std::vector<std::string> noiseColumns(const Trial& trial);

/// Returns the columns of noiseColumns() that do not determine the slip.
std::vector<std::string> allButSlip(const Trial& trial);

/// Returns the noise floor: the root mean square of each scaled channel that sensor errors cause. The floor
/// includes the errors of slip and load, which act through `slopes`; NaN for channels without measurements.
/// `level` contains a model's predictions, rows x kChannels.
std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise);

/// Returns knots at quantiles of the distinct finite values of x: at most `most` knots, fewer for few values.
std::vector<double> quantileKnots(const Eigen::VectorXd& x, int most);

/// Returns the basis of natural cubic splines in terms of their values at the knots, rows x knots. Each row
/// sums to 1; a row is zero where x is NaN.
Eigen::MatrixXd splineBasis(const Eigen::VectorXd& x, const std::vector<double>& knots);

/// Returns an orthonormal basis of the columns; directions of relative length below 1e-8 are dropped.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace talus::terramech
