#include <algorithm>

#include <talus/terramech/calibration/fit/candidate_columns.hpp>
#include <talus/terramech/calibration/noise/noise_floor.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>

namespace talus::terramech {

TrialFit::TrialFit(const RefinedModel& base, const Trial& trial, bool fit_soil,
                   const std::function<bool(double)>& go_on)
    : fit_soil_(fit_soil),
      model_(base),
      prior_modulus_(base.soil.cohesive_modulus + base.soil.frictional_modulus),
      rows_(trial) {
  setRows(trial);
  if (!planFor(model_).free.empty()) fitSoil(go_on);
}

void TrialFit::setRows(const Trial& trial) {
  rows_ = CalibratedRows{trial};
  folds_ = foldsOf(trial);
  solved_ = {};
  refresh();
}

void TrialFit::refresh() {
  rows_.calibrate(model_, solved_);
  if (!rows_.whitening().common.unit.empty()) {
    SolvedContacts solved = solved_;
    rows_.setRunError(runErrorOf(standing(model_, rows_.residual(), solved)));
  }
  misfit_ = misfitOf(rows_.white(), rows_.trial());
}

FitPlan TrialFit::planFor(const RefinedModel& model) const {
  FitPlan plan = fitPlan(model, fit_soil_);
  plan.prior_modulus = prior_modulus_;
  plan.misfit = misfit_;
  return plan;
}

Fit TrialFit::fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const {
  FitPlan plan = planFor(model);
  plan.iterations = iterations;
  return fitModel(model, rows_.trial(), rows_.whitening(), plan, solved);
}

RefinedModel TrialFit::fitted(const RefinedModel& model, int iterations) const {
  SolvedContacts solved = solved_;
  return fit(model, iterations, solved).model;
}

void TrialFit::refit(int iterations) {
  model_ = fit(model_, iterations, solved_).model;
  refresh();
}

void TrialFit::settle(const RefinedModel& start) {
  model_ = start;
  for (int round = 0; round < 2; ++round) refit(12);
}

/// Fits the soil to rowsOfSoil().
void TrialFit::fitSoil(const std::function<bool(double)>& go_on) {
  const Trial all = rows_.trial();
  const std::vector<char> straight = rowsOfSoil(all);
  const bool part = std::find(straight.begin(), straight.end(), 0) != straight.end();
  if (part) setRows(subset(all, straight));
  for (int round = 0; round < 3 && go_on(0.0); ++round) refit(30);
  if (part) setRows(all);
}

NullModel TrialFit::standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                             SolvedContacts& solved) const {
  return standing(model, planFor(model), residual, solved);
}

NullModel TrialFit::standing(const RefinedModel& model, const FitPlan& plan, const Eigen::MatrixXd& residual,
                             SolvedContacts& solved) const {
  const Trial& trial = rows_.trial();
  const Whitening& whitening = rows_.whitening();
  NullModel null{whitening.shared(),
                 whitening.common.unit,
                 folds_,
                 whitening.rowByRow(residual),
                 linearised(model, trial, whitening, plan, solved),
                 whitening.common.run,
                 static_cast<Eigen::Index>(plan.soil_prior.size())};
  const std::optional<Eigen::MatrixXd>& by_slip = rows_.bySharedSlip();
  if (!by_slip) return null;
  // The slip error common to all rows is an additional parameter with prior mean 0 and standard deviation 1.
  LinearModel& known = null.known;
  const Eigen::Index at = known.columns.cols();
  known.columns.conservativeResize(null.residual.size(), at + 1);
  known.columns.col(at) =
      whitening.rowByRow(trial.measured.array().isFinite().select(*by_slip, 0.0).matrix());
  known.prior.mean.conservativeResize(at + 1);
  known.prior.precision.conservativeResize(at + 1);
  known.prior.mean[at] = 0.0;
  known.prior.precision[at] = 1.0;
  return null;
}

double TrialFit::scoreOf(const RefinedModel& fitted) const {
  SolvedContacts solved = solved_;
  const Eigen::MatrixXd residual = rows_.trial().measured - predictRows(fitted, rows_.trial(), solved);
  FitPlan plan = planFor(fitted);
  std::erase_if(plan.free, [&](const FittedParameter& p) {  // (T45)
    const ParameterRange range = rangeOf(fitted, p);
    return p.effect >= 0 && (value(fitted, p) <= range.low || value(fitted, p) >= range.high);
  });
  return fittedScore(standing(fitted, plan, residual, solved));
}

void TrialFit::setModel(const RefinedModel& model) {
  model_ = model;
  rows_.compare(model_, solved_);
}

Eigen::MatrixXd TrialFit::finish(bool again) {
  const FitPlan plan = planFor(model_);
  if (again) model_ = fitModel(model_, rows_.trial(), rows_.whitening(), plan, solved_).model;
  model_.fitted = plan.free;
  Eigen::MatrixXd covariance = parameterCovariance(model_, rows_.trial(), rows_.whitening(), plan, solved_);
  model_.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  rows_.compare(model_, solved_);
  return covariance;
}

Channel TrialFit::strongest(std::size_t effect) const {
  RefinedModel without = model_;
  without.effects.erase(without.effects.begin() + static_cast<long>(effect));
  SolvedContacts solved = solved_;
  const Trial& trial = rows_.trial();
  const Eigen::VectorXd moved = rows_.whitening().marginal(
      trial.measured.array().isFinite().select(predictRows(without, trial, solved) - rows_.level(), 0.0));
  std::array<double, kChannels> size{};
  for (Eigen::Index i = 0; i < moved.size(); ++i)
    size[static_cast<std::size_t>(i % kChannels)] += moved[i] * moved[i];
  return static_cast<Channel>(std::max_element(size.begin(), size.end()) - size.begin());
}

std::array<double, kChannels> TrialFit::noiseFloor(const SensorNoise& noise) {
  const InputSlopes slopes = inputSlopes(model_, asMeasured(rows_.trial()), solved_);
  return terramech::noiseFloor(rows_.trial(), rows_.level(), slopes, noise);
}

}  // namespace talus::terramech
