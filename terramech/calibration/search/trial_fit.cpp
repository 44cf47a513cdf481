#include <algorithm>
#include <string>
#include <vector>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

RefinedModel asDriven(RefinedModel model, const Trial& trial) {
  constexpr double kSlopeError_rad = 0.005;
  if (trial.moment.empty()) return model;
  double load_N = 0.0;
  for (const double w : trial.load_N) load_N += w / trial.rows();
  if (!model.stated.drawbar_pull_N) model.stated.drawbar_pull_N = kSlopeError_rad * load_N;
  const auto& columns = trial.covariates;
  const bool has_passes = std::find(columns.begin(), columns.end(), "pass_index") != columns.end();
  if (!has_passes || knowsPasses(model.effects)) return model;
  model.effects.push_back({.name = "multipass_reload",
                           .covariate = "pass_index",
                           .channel = Channel::Sinkage,
                           .parameters = {model.soil.rut_stiffness - 1.0, 1.0}});
  return model;
}

Eigen::VectorXd CalibratedRows::sinkages_m() const {
  Eigen::VectorXd z(level_.rows());
  for (int row = 0; row < trial_.rows(); ++row)
    z[row] = level_(row, static_cast<int>(Channel::Sinkage)) * trial_.denominator(row, Channel::Sinkage);
  return z;
}

void CalibratedRows::backToMeasured() {
  for (std::size_t row = 0; row < trial_.states.size(); ++row) {
    setSlip(trial_.states[row], trial_.slip[row]);
    trial_.states[row].load_N = trial_.load_N[row];
  }
}

/// The stated errors. An error of the load that is not stated has the scatter about set loads as its prior.
StatedSensors CalibratedRows::knownSensors(const RefinedModel& model) const {
  StatedSensors sensors = model.stated;
  if (set_ && !sensors.load_N) sensors.load_N = set_->scatter * medianOf(trial_.load_N);
  return sensors;
}

void CalibratedRows::settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
                            const InputSlopes& measured_slopes, RefinedModel& model, SolvedContacts& solved) {
  backToMeasured();
  model.noise = fitNoise(trial_, noise_alone, level, measured_slopes, knownSensors(model));
  calibrateInputs(trial_, model.noise, set_);
  level_ = predictRows(model, trial_, solved);
  residual_ = trial_.measured - level_;  // (T1)
  const InputSlopes slopes = inputSlopes(model, trial_, solved);
  by_slip_.reset();
  const Eigen::VectorXd shared = sharedSlipStd(trial_, model.noise);
  if (shared.size() > 0) by_slip_ = shared.asDiagonal() * slopes.by_slip;
  whitening_ = terramech::whitening(trial_, level_, slopes, model.noise);
}

void CalibratedRows::shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level,
                                 const InputSlopes& measured_slopes, RefinedModel& model,
                                 SolvedContacts& solved) {
  std::vector<std::string> timeless;
  for (const std::string& column : noiseColumns(trial_))
    if (column != "time_s") timeless.push_back(column);
  const std::vector<int> unit = runUnits(trial_, whitening_, withoutSmooth(trial_, residual_, timeless));
  if (!unit.empty()) {  // excludes the shared error from the noise of single rows
    const double rows = trial_.rows(), kept = rows - (*std::max_element(unit.begin(), unit.end()) + 1);
    smooth -= unitMeans(smooth, whitening_.std, unit);
    if (kept > 4.0) settle(std::sqrt(rows / kept) * smooth, level, measured_slopes, model, solved);
  }
  whitening_.common.unit = unit;
  if (unit.empty()) return;
  whitening_.common.by_soil = soilFactors(model, trial_, level_, solved);
  whitening_.common.run = roughRunError(whitening_);
}

void CalibratedRows::findSetLoads(const RefinedModel& model, const Eigen::MatrixXd& measured,
                                  SolvedContacts& solved) {
  set_ = setLoads(trial_);
  if (!set_) return;
  // A smooth of the measured loads would absorb their errors about the set loads.
  for (std::size_t r = 0; r < trial_.states.size(); ++r)
    trial_.states[r].load_N = set_->load_N[static_cast<Eigen::Index>(r)];
  const auto likelihood = [&](const Eigen::MatrixXd& residual) {
    const Eigen::MatrixXd e = withoutSmooth(trial_, residual, noiseColumns(trial_));
    double sum = 0.0;
    for (Eigen::Index c = 0; c < kChannels; ++c)
      if (const auto there = e.col(c).array().isFinite(); there.any())
        sum -= 0.5 * static_cast<double>(there.count()) *
               std::log(there.select(e.col(c).array().square(), 0.0).sum());
    return sum;
  };
  if (likelihood(trial_.measured - predictRows(model, trial_, solved)) > likelihood(measured))
    return;  // (T14)
  set_.reset();
  backToMeasured();
}

void CalibratedRows::calibrate(RefinedModel& model, SolvedContacts& solved) {
  backToMeasured();
  const Eigen::MatrixXd level = predictRows(model, trial_, solved);
  const InputSlopes slopes = inputSlopes(model, trial_, solved);
  const Eigen::MatrixXd measured = trial_.measured - level;
  // If the slip varies more than any possible error, no estimate of the error is needed.
  const SensorNoise unlimited{.slip_relative = 1.0};
  findSetLoads(model, measured, solved);
  Eigen::MatrixXd smooth = withoutSmooth(trial_, measured, noiseColumns(trial_));
  if (!inputsAreSeen(trial_, unlimited)) {
    const Eigen::MatrixXd left = withoutSmooth(trial_, measured, allButSlip(trial_));
    if (!inputsAreSeen(trial_, fitNoise(trial_, left, level, slopes, model.stated))) smooth = left;
  }
  settle(smooth, level, slopes, model, solved);
  shareWithin(smooth, level, slopes, model, solved);
  white_ = whitening_.apply(residual_);
}

void CalibratedRows::setRunError(const RunError& run) {
  whitening_.common.run = run;
  white_ = whitening_.apply(residual_);
}

void CalibratedRows::compare(const RefinedModel& model, SolvedContacts& solved) {
  level_ = predictRows(model, trial_, solved);
  residual_ = trial_.measured - level_;
  white_ = whitening_.apply(residual_);
}

TrialFit::TrialFit(const RefinedModel& base, const Trial& trial, bool fit_soil,
                   const std::function<bool(double)>& go_on, bool fit_effects)
    : fit_soil_(fit_soil),
      fit_effects_(fit_effects),
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
  if (!fit_effects_) std::erase_if(plan.free, [](const FittedParameter& p) { return p.effect >= 0; });
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

void TrialFit::settle(const RefinedModel& start) {
  model_ = start;
  for (int round = 0; round < 2; ++round) {
    model_ = fit(model_, 12, solved_).model;
    refresh();
  }
}

/// Fits the soil to rowsOfSoil(). Effects are fitted only if these are all rows, because straight wheels do not
/// determine the effects of a slip angle.
void TrialFit::fitSoil(const std::function<bool(double)>& go_on) {
  const Trial all = rows_.trial();
  const std::vector<char> straight = rowsOfSoil(all);
  const bool part = std::find(straight.begin(), straight.end(), 0) != straight.end();
  if (part) setRows(subset(all, straight));
  for (int round = 0; round < 3 && go_on(0.0); ++round) {
    FitPlan plan = planFor(model_);
    plan.iterations = 30;
    if (part) std::erase_if(plan.free, [](const FittedParameter& p) { return p.effect >= 0; });
    model_ = fitModel(model_, rows_.trial(), rows_.whitening(), plan, solved_).model;
    refresh();
  }
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

Channel TrialFit::strongest(std::size_t effect, std::size_t count) const {
  RefinedModel without = model_;
  const auto first = without.effects.begin() + static_cast<long>(effect);
  without.effects.erase(first, first + static_cast<long>(count));
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
