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

/// What a fit moves and what it knows beforehand.
struct FitPlan {
  std::vector<FittedParameter> free;
  /// By index into soilParameters(), in the parameter's unit (a step from the start for log_stiffness).
  std::map<int, Estimate> soil_prior;
  std::map<int, Estimate> effect_prior;  ///< by number of an effect, of its first parameter
  /// k_c + k_phi that log_stiffness is counted from; without it, that of the model at the start.
  std::optional<double> prior_modulus;
  /// Mean square of the whitened residuals where the model lacks something (Birge's ratio), else 1: as much less do
  /// the rows count against the priors.
  double misfit = 1.0;
  int iterations = 12;
  /// whitened, kept for all iterations; null: taken anew in each.
  const Eigen::MatrixXd* derivative = nullptr;
};

/// A fitted model.
struct Fit {
  RefinedModel model;
  double chi2 = 0.0;  ///< of the whitened residuals, priors left out
  double prior_chi2 = 0.0;
  double cost() const { return chi2 + prior_chi2; }
};

/// Levenberg-Marquardt on whitened residuals inside the parameters' bounds. `solved` as predictRows().
Fit fitModel(const RefinedModel& start, const Trial& trial, const Whitening& whitening, const FitPlan& plan,
             SolvedContacts& solved);

/// What is known beforehand of free parameter `k` of a plan, in its own unit; of log_stiffness the step from
/// where the model stands.
std::optional<Estimate> priorOf(const RefinedModel& model, const FitPlan& plan, std::size_t k);

/// Covariance of the free parameters [own units] about a model that was fitted.
Eigen::MatrixXd parameterCovariance(const RefinedModel& fitted, const Trial& trial,
                                    const Whitening& whitening, const FitPlan& plan, SolvedContacts& solved);

/// Whitened (or marginally scaled) derivative of the readings by each parameter, rows*kChannels x parameters.
Eigen::MatrixXd jacobian(const RefinedModel& model, const Trial& trial,
                         const std::vector<FittedParameter>& free, SolvedContacts& solved,
                         const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& scale);

/// FitPlan::misfit of these whitened residuals of the rows of a trial.
double misfitOf(const Eigen::VectorXd& white, const Trial& trial);

/// Everything that a model lets a fit move: its effects, and the soil's parameters that are stated with a
/// standard deviation, or all of them, under vague priors, when `fit_soil`. An effect's first number is believed to
/// be 0 give or take fifty typical sizes: nothing where rows show the effect, no effect where none does.
FitPlan fitPlan(const RefinedModel& model, bool fit_soil);

/// A soil whose file states no standard deviation is known to half of what is known of any soil (ours): cohesion to
/// 1000 Pa, friction angle to 0.06 rad, n to 0.125, stiffness to a factor of e^1.5, K to 6 mm, c1 to 0.04, c2 to 0.06.
void giveDefaultDeviations(RefinedModel& model);

/// All fitted numbers of effect number `effect`.
std::vector<FittedParameter> parametersOf(const RefinedModel& model, int effect);

/// Typical step of a parameter and its bounds.
struct ParameterRange {
  double low, high, scale;
};
ParameterRange rangeOf(const RefinedModel& model, const FittedParameter& parameter);

}  // namespace talus::terramech
