#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// True drawbar pull that a base or refined wheel model predicts, without sensor errors (ours). In contrast,
/// predict() returns sensor readings with sensor errors.

/// Returns true if an effect of a model changes only a sensor reading and leaves the wheel-soil contact
/// unchanged.
bool isSensorFault(const Effect& effect);

/// Returns the model without sensor errors, i.e. without offset, drift and noise of the channels. The errors
/// of slip and load and the covariance of the fitted parameters remain. If no parameter was fitted, the prior
/// of the soil becomes the covariance.
RefinedModel groundTruthOf(const RefinedModel& model);

/// Drawbar pull over load DP/W, sinkage over radius z/r and torque ratio T/(rW) of a wheel [-].
struct ModelPull {
  Estimate pull_over_load;
  Estimate sinkage_over_radius;
  double torque_over_load_radius = 0.0;
};

/// Returns the pull, sinkage and torque that a model predicts at the load and slip of `state`. `truth` is a
/// model from groundTruthOf(). Never throws for a valid state.
ModelPull pullOf(const RefinedModel& truth, const WheelState& state);

/// Returns the pull at the reference slip, in (0, 1], and the maximum pull over the slips kForecastSlips. The
/// slip is an exact input without reading error. Throws std::invalid_argument for a reference slip outside
/// (0, 1].
PullForecast forecastPull(const RefinedModel& truth, const WheelState& state, double reference_slip = 0.5);

/// Returns the names of the formulas of drawbar_pull.hpp that compute drawbar pull over load DP/W from
/// readings: "single-force" (ours, pullOverLoad()), "small-angle" (thesis Eq. 3.6), "triangular" (Eq. 3.12),
/// "plane" (Eq. 3.21).
const std::vector<std::string>& pullFormulas();

/// Returns DP/W [-] of a sample by the named formula. The standard deviation includes the errors of the
/// readings and the rms error of the formula over thesis Table 2.1 (`talus reproduce --goals`). Throws
/// std::invalid_argument for an unknown name, and the exceptions of drawbar_pull.hpp.
Estimate pullOverLoadBy(const std::string& formula, const Wheel& wheel, const WheelSample& sample,
                        const ReadingErrors& errors);

/// Gaussian prior of cohesion c and tan(phi) for the linear methods, which fit a Mohr-Coulomb line.
struct StrengthPrior {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< mean of c [Pa] and tan phi [-]
  /// Covariance of (c, tan phi); zero for an exactly known value.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double probability = 1.0;  ///< weight among several priors; their weights are scaled to sum 1
};

/// Returns the prior of (c, tan phi) from the prior of a soil, with std(tan phi) = std(phi)/cos(phi)^2.
StrengthPrior strengthPrior(const SoilPrior& soil);

/// Returns a fitted Mohr-Coulomb line combined with a mixture of priors by Bayes' rule (ours). The fit with
/// its covariance counts as one reading of (c, tan phi); each prior is weighted by its likelihood of the fit.
/// The result contains mean and covariance of the mixture; the remaining fields of `fit`, including `unseen`,
/// are copied. Throws std::domain_error if the fit has no covariance (fewer than three samples), and
/// std::invalid_argument without a prior.
ShearStrength withPrior(const ShearStrength& fit, std::span<const StrengthPrior> priors);

}  // namespace talus::terramech
