#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Free parameters and priors of a fit of a wheel model.
struct FitPlan {
  std::vector<FittedParameter> free;  ///< parameters that the fit may change
  /// Priors of soil parameters, by index into soilParameters(), in the parameter's unit. The prior of
  /// log_stiffness is that of the step from the start model.
  std::map<int, Estimate> soil_prior;
  /// Prior of the first parameter of an effect, by index of the effect.
  std::map<int, Estimate> effect_prior;
  /// Sum k_c + k_phi of the sinkage moduli at which log_stiffness is 0; nullopt: the sum of the start model.
  std::optional<double> prior_modulus;
  /// Mean square of the whitened residuals (Birge's ratio) if the model is incomplete, otherwise 1. The
  /// weight of the rows relative to the priors is divided by this value.
  double misfit = 1.0;
  int iterations = 12;  ///< greatest number of iterations
};

/// Fitted model with its sums of squares.
struct Fit {
  RefinedModel model;
  double chi2 = 0.0;  ///< sum of squares of the whitened residuals, without priors
  /// Sum of squares of the parameters' deviations from their priors, in standard deviations.
  double prior_chi2 = 0.0;
  double cost() const { return chi2 + prior_chi2; }
};

/// Fits a model to the rows of a trial by the Levenberg-Marquardt method. The fit minimises the squared
/// whitened residuals plus the priors; parameters are bounded. `solved` is the cache of predictRows().
Fit fitModel(const RefinedModel& start, const Trial& trial, const Whitening& whitening, const FitPlan& plan,
             SolvedContacts& solved);

/// Returns the prior of free parameter number `k` of a plan, in the parameter's unit, or nullopt without a
/// prior. For log_stiffness the prior is that of the step from the model's current value.
std::optional<Estimate> priorOf(const RefinedModel& model, const FitPlan& plan, std::size_t k);

/// Returns the covariance of the free parameters of a fitted model, in the units of the parameters.
Eigen::MatrixXd parameterCovariance(const RefinedModel& fitted, const Trial& trial,
                                    const Whitening& whitening, const FitPlan& plan, SolvedContacts& solved);

/// Returns the derivative of the predictions with respect to each parameter in `free`, rows*kChannels x
/// parameters. `scale` (whitening or marginal scaling) is applied to each column.
Eigen::MatrixXd jacobian(const RefinedModel& model, const Trial& trial,
                         const std::vector<FittedParameter>& free, SolvedContacts& solved,
                         const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& scale);

/// Returns FitPlan::misfit for the whitened residuals of a trial.
double misfitOf(const Eigen::VectorXd& white, const Trial& trial);

/// Returns a plan with all free parameters of a model: the parameters of its effects, and the soil parameters
/// that have a standard deviation. With `fit_soil`, all soil parameters are free and have vague priors. The
/// first parameter of an effect has the prior 0 with a standard deviation of fifty typical sizes. This prior
/// is negligible if the rows determine the effect; otherwise the fitted effect is 0.
FitPlan fitPlan(const RefinedModel& model, bool fit_soil);

/// Replaces the prior of the model's soil by the vague one of fitPlan().
void giveVaguePrior(RefinedModel& model);

/// Assigns default standard deviations to the soil of a model whose file states no standard deviations
/// (ours). The default values are half the general uncertainty of soils: cohesion 1000 Pa, friction angle
/// 0.06 rad, n 0.125, stiffness a factor of e^1.5, K 6 mm, c1 0.04, c2 0.06.
void giveDefaultDeviations(RefinedModel& model);

/// Returns the fitted parameters of the effect with index `effect`.
std::vector<FittedParameter> parametersOf(const RefinedModel& model, int effect);

/// Bounds and typical step of a parameter, in its unit.
struct ParameterRange {
  double low, high, scale;
};
ParameterRange rangeOf(const RefinedModel& model, const FittedParameter& parameter);

/// A wheel model, evaluated on the rows of a trial (table of measured rows).
struct ModelOnRows {
  const RefinedModel& model;
  const Trial& trial;
  /// Transforms residuals to unit variance.
  const Whitening& whitening;
  const Eigen::MatrixXd& level;  ///< predictions of the model, rows x kChannels
  /// Sinkage of the model in each row.
  const Eigen::VectorXd& sinkage_m;
  /// Solved wheel-soil contact of each row.
  const SolvedContacts& solved;
};

/// Returns the linearised contribution of a candidate (possible addition to the model), whitened row by row.
/// The contribution of an effect is the change of the predictions at the effect's typical size, with the
/// derivatives with respect to its other parameters. The contribution of a curve consists of the derivatives
/// with respect to the curve's values at the knots.
Contender contenderOf(const Candidate& candidate, const ModelOnRows& at);

/// Returns the derivatives of the predictions of a fitted model with respect to the free parameters of a
/// plan. The unit of each parameter is rangeOf().scale.
LinearModel linearised(const RefinedModel& fitted, const Trial& trial, const Whitening& whitening,
                       const FitPlan& plan, SolvedContacts& solved);

/// Returns the model with the effects of a candidate appended to its effects.
RefinedModel withCandidate(const RefinedModel& model, const Candidate& candidate);

}  // namespace talus::terramech
