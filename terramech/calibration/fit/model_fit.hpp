#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::terramech {

/// Free parameters and priors of a fit.
struct FitPlan {
  std::vector<FittedParameter> free;
  /// By index into soilParameters(), in the parameter's unit (for log_stiffness the step from the start).
  std::map<int, Estimate> soil_prior;
  std::map<int, Estimate> effect_prior;  ///< by index of the effect; prior of its first parameter
  /// Reference value k_c + k_phi (sum of the sinkage moduli) of log_stiffness; nullopt: that of the start
  /// model.
  std::optional<double> prior_modulus;
  /// Mean square of the whitened residuals (Birge's ratio) if the model is incomplete, else 1. The weight of
  /// the rows relative to the priors is divided by this factor.
  double misfit = 1.0;
  int iterations = 12;
  /// Whitened derivative, used in all iterations; null: recomputed in each iteration.
  const Eigen::MatrixXd* derivative = nullptr;
};

/// A fitted model.
struct Fit {
  RefinedModel model;
  double chi2 = 0.0;  ///< sum of squares of the whitened residuals, without priors
  double prior_chi2 = 0.0;
  double cost() const { return chi2 + prior_chi2; }
};

/// Fits a model by the Levenberg-Marquardt method to the whitened residuals, with bounded parameters.
/// `solved` is the cache of predictRows().
Fit fitModel(const RefinedModel& start, const Trial& trial, const Whitening& whitening, const FitPlan& plan,
             SolvedContacts& solved);

/// Prior of free parameter `k` of a plan, in the parameter's unit; for log_stiffness as a step from the
/// model's current value.
std::optional<Estimate> priorOf(const RefinedModel& model, const FitPlan& plan, std::size_t k);

/// Covariance of the free parameters [units of the parameters] at a fitted model.
Eigen::MatrixXd parameterCovariance(const RefinedModel& fitted, const Trial& trial,
                                    const Whitening& whitening, const FitPlan& plan, SolvedContacts& solved);

/// Derivative of the predictions by each parameter, scaled by `scale` (whitening or marginal scaling),
/// rows*kChannels x parameters.
Eigen::MatrixXd jacobian(const RefinedModel& model, const Trial& trial,
                         const std::vector<FittedParameter>& free, SolvedContacts& solved,
                         const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& scale);

/// FitPlan::misfit for the whitened residuals of a trial.
double misfitOf(const Eigen::VectorXd& white, const Trial& trial);

/// Plan with all free parameters of a model: its effects, and the soil parameters that have a standard
/// deviation, or with `fit_soil` all soil parameters under vague priors. The prior of an effect's first
/// parameter is 0 with a standard deviation of fifty typical sizes: negligible if the rows determine the
/// effect; otherwise the fitted effect is 0.
FitPlan fitPlan(const RefinedModel& model, bool fit_soil);

/// Assigns default standard deviations to a soil whose file states none (ours): half the general uncertainty
/// of soils. Cohesion 1000 Pa, friction angle 0.06 rad, n 0.125, stiffness a factor of e^1.5, K 6 mm, c1
/// 0.04, c2 0.06.
void giveDefaultDeviations(RefinedModel& model);

/// The fitted parameters of the effect with index `effect`.
std::vector<FittedParameter> parametersOf(const RefinedModel& model, int effect);

/// Bounds and typical step of a parameter.
struct ParameterRange {
  double low, high, scale;
};
ParameterRange rangeOf(const RefinedModel& model, const FittedParameter& parameter);

}  // namespace talus::terramech
