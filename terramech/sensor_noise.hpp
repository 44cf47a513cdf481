#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <terramech/moment_slip.hpp>
#include <terramech/trial.hpp>

namespace talus::terramech {

/// Slopes of the scaled readings in the two inputs that are themselves measured, rows x kChannels.
struct InputSlopes {
  Eigen::MatrixXd by_slip;  ///< per unit of slip
  Eigen::MatrixXd by_load;  ///< per relative change of load, forces over the measured load
};
InputSlopes inputSlopes(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Maximum a posteriori noise of sensors and inputs from what is left of the residuals once every smooth
/// dependence on a covariate is taken out (so that a missing effect does not pass for noise). Errors of slip
/// and load show as deviations that move all channels along `slopes` together. Stated standard deviations are
/// priors of 25 %, others are 3 % within a factor 2. `level` is the model's reading, for the relative parts.
SensorNoise fitNoise(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const StatedSensors& stated);

/// Residuals with an additive smooth of these columns taken out, scaled up for the freedom that it took. NaN
/// stay.
Eigen::MatrixXd withoutSmooth(const Trial& trial, const Eigen::MatrixXd& residual,
                              const std::vector<std::string>& columns);

/// The covariates of a trial that do not tell its slip.
std::vector<std::string> allButSlip(const Trial& trial);

/// Whether the measured slip varies by more than its own error may: by twice as much. Where it does not, what
/// its error does to the readings is itself a smooth function of the measured slip, and a smooth of it would
/// hide the error. `noise` is that of residuals without a smooth of slip; more than a tenth of the slip is
/// not taken for error.
bool slipIsSeen(const Trial& trial, const SensorNoise& noise);

/// Standard deviation of the error that the mean of the measured slips has.
double levelStd(const Trial& trial, const SensorNoise& noise);

/// Sets a slip, and the speed over ground with it where the row's speeds agree with the slip it had: the
/// three were then had from two.
void setSlip(WheelState& state, double slip);

/// Replaces slip and load of the states by their posterior means given what was measured, and sets their
/// variances: the distribution of true values is found from all rows (nonparametric maximum likelihood,
/// kiefer_wolfowitz_1956), so that the attenuation by noisy inputs is taken out. Call it with the measured
/// slip and load in the states.
void calibrateInputs(Trial& trial, const SensorNoise& noise);

/// Per row the factor that makes residuals of unit variance and uncorrelated: inverse of the lower Cholesky
/// factor of their covariance, zero rows and columns for missing channels.
struct Whitening {
  std::vector<Eigen::Matrix4d> factor;
  Eigen::MatrixXd std;  ///< marginal standard deviations, rows x kChannels
  MomentSlip shared{};  ///< what is left common to rows of one moment

  Eigen::VectorXd apply(const Eigen::MatrixXd& residual) const;     ///< rows*kChannels; 0 where missing
  Eigen::VectorXd marginal(const Eigen::MatrixXd& residual) const;  ///< each over its std
};
/// The rows that `keep` marks.
Whitening subset(const Whitening& whitening, const std::vector<char>& keep);

Whitening whitening(const Trial& trial, const Eigen::MatrixXd& level, const InputSlopes& slopes,
                    const SensorNoise& noise);

}  // namespace talus::terramech
