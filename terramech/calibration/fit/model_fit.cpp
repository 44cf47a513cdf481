#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>

namespace talus::terramech {
namespace {

/// Prior means and standard deviations of soils in general, in the units of the parameters.
const std::map<std::string, Estimate>& vagueSoil() {
  static const std::map<std::string, Estimate> prior{{"cohesion_Pa", {1500.0, 2000.0}},
                                                     {"friction_angle_rad", {0.55, 0.12}},
                                                     {"sinkage_exponent", {1.0, 0.25}},
                                                     {"log_stiffness", {0.0, 3.0}},
                                                     {"shear_modulus_m", {0.02, 0.012}},
                                                     {"c1", {0.43, 0.08}},
                                                     {"c2", {0.32, 0.12}}};
  return prior;
}

bool isLogStiffness(const FittedParameter& p) {
  return p.effect < 0 &&
         std::string_view(soilParameters()[static_cast<std::size_t>(p.index)].name) == "log_stiffness";
}

bool isOfPeak(const FittedParameter& p) {
  const std::string_view name = p.effect < 0 ? soilParameters()[static_cast<std::size_t>(p.index)].name : "";
  return name == "c1" || name == "c2";
}

double modulusOf(const Soil& soil) {
  return soil.cohesive_modulus + soil.frictional_modulus;
}

/// Limits c2 so that the stress peak (c1 + c2 i) theta_1 stays inside the contact at every slip in [-1, 1];
/// other functions reject a soil without this property.
void keepPeakInside(Soil& soil) {
  const double room = std::max(0.0, std::min(soil.c1, 1.0 - soil.c1));
  soil.c2 = std::clamp(soil.c2, -room, room);
}

/// A point of the search: the model, its whitened residuals and its departure from the priors.
class FitPoint {
 public:
  FitPoint(const RefinedModel& start, const Trial& trial, const Whitening& whitening, const FitPlan& plan,
           SolvedContacts& solved)
      : trial_(trial),
        whitening_(whitening),
        plan_(plan),
        solved_(solved),
        model_(start),
        log_stiffness_(0.0),
        residual_(residualOf(start, solved)) {
    for (std::size_t k = 0; k < plan.free.size(); ++k) {
      prior_.push_back(terramech::priorOf(start, plan, k));
      if (prior_.back()) prior_.back()->std /= std::sqrt(plan.misfit);  // (T23)
    }
  }

  double chi2() const { return residual_.squaredNorm(); }
  double priorChi2() const { return priorResidual(model_, log_stiffness_).squaredNorm(); }
  double cost() const { return chi2() + priorChi2(); }
  const RefinedModel& model() const { return model_; }

  /// Normal equations in scaled parameters.
  void linearise(Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) {
    const Eigen::MatrixXd j = jacobianHere();
    const auto n = static_cast<Eigen::Index>(plan_.free.size());
    normal = j.transpose() * j;
    gradient = j.transpose() * residual_;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto prior = priorOf(k);
      if (!prior) continue;
      const double s = scale(k) / prior->std;
      normal(k, k) += s * s;
      gradient[k] += s * (prior->value - valueOf(model_, log_stiffness_, k)) / prior->std;
    }
  }

  /// Moves by scaled steps, limited to the bounds, if the step lowers the cost.
  bool tryStep(const Eigen::VectorXd& step) {
    RefinedModel moved = model_;
    double stiffness = log_stiffness_;
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      const auto& p = plan_.free[static_cast<std::size_t>(k)];
      const ParameterRange range = rangeOf(model_, p);
      const double wanted = value(model_, p) + std::clamp(step[k], -20.0, 20.0) * range.scale;
      const double now = std::clamp(wanted, range.low, range.high);
      setValue(moved, p, now);
      if (isLogStiffness(p)) stiffness += now;
    }
    if (std::any_of(plan_.free.begin(), plan_.free.end(), isOfPeak)) keepPeakInside(moved.soil);
    SolvedContacts solved = solved_;
    const Eigen::VectorXd residual = residualOf(moved, solved);
    const double cost_moved = residual.squaredNorm() + priorResidual(moved, stiffness).squaredNorm();
    if (!(cost_moved < cost())) return false;
    model_ = moved;
    residual_ = residual;
    solved_ = std::move(solved);
    log_stiffness_ = stiffness;
    return true;
  }

  Eigen::VectorXd scales() const {
    Eigen::VectorXd s(static_cast<Eigen::Index>(plan_.free.size()));
    for (Eigen::Index k = 0; k < s.size(); ++k) s[k] = scale(k);
    return s;
  }

  /// Solves the damped normal equations with step 0 for parameters at a bound that would leave the range.
  /// Limiting these parameters after the solution would make the other steps wrong.
  Eigen::VectorXd stepInside(Eigen::MatrixXd damped, Eigen::VectorXd gradient) const {
    for (Eigen::Index held = 0; held <= gradient.size(); ++held) {
      const Eigen::VectorXd step = damped.ldlt().solve(gradient);
      bool leaves = false;
      for (Eigen::Index k = 0; k < step.size(); ++k) {
        if (!leavesBound(k, step[k])) continue;
        leaves = true;
        damped.row(k).setZero();
        damped.col(k).setZero();
        damped(k, k) = 1.0;
        gradient[k] = 0.0;
      }
      if (!leaves) return step;
    }
    return Eigen::VectorXd::Zero(gradient.size());
  }

  Eigen::MatrixXd jacobianHere() {
    Eigen::MatrixXd j = jacobian(model_, trial_, plan_.free, solved_,
                                 [&](const Eigen::MatrixXd& m) { return whitening_.apply(m); });
    for (Eigen::Index k = 0; k < j.cols(); ++k) j.col(k) *= scale(k);
    return j;
  }

 private:
  double scale(Eigen::Index k) const {
    return rangeOf(model_, plan_.free[static_cast<std::size_t>(k)]).scale;
  }

  // Returns the prior; for log_stiffness as a step from the start of the search.
  std::optional<Estimate> priorOf(Eigen::Index k) const { return prior_[static_cast<std::size_t>(k)]; }

  bool leavesBound(Eigen::Index k, double step) const {
    const auto& p = plan_.free[static_cast<std::size_t>(k)];
    if (isLogStiffness(p)) return false;
    const ParameterRange range = rangeOf(model_, p);
    const double now = value(model_, p);
    return (step < 0.0 && now <= range.low) || (step > 0.0 && now >= range.high);
  }

  double valueOf(const RefinedModel& model, double log_stiffness, Eigen::Index k) const {
    const auto& p = plan_.free[static_cast<std::size_t>(k)];
    return isLogStiffness(p) ? log_stiffness : value(model, p);
  }

  Eigen::VectorXd priorResidual(const RefinedModel& model, double log_stiffness) const {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(plan_.free.size()));
    for (Eigen::Index k = 0; k < r.size(); ++k)
      if (const auto prior = priorOf(k))
        r[k] = (valueOf(model, log_stiffness, k) - prior->value) / prior->std;
    return r;
  }

  Eigen::VectorXd residualOf(const RefinedModel& model, SolvedContacts& solved) const {
    return whitening_.apply(trial_.measured - predictRows(model, trial_, solved));
  }

  const Trial& trial_;
  const Whitening& whitening_;
  const FitPlan& plan_;
  SolvedContacts& solved_;
  RefinedModel model_;
  double log_stiffness_;
  Eigen::VectorXd residual_;
  std::vector<std::optional<Estimate>> prior_;
};

}  // namespace

std::optional<Estimate> priorOf(const RefinedModel& model, const FitPlan& plan, std::size_t k) {
  const FittedParameter& p = plan.free[k];
  // This prior determines the value at a knot without nearby rows.
  if (p.effect >= 0 && model.effects[static_cast<std::size_t>(p.effect)].empirical())
    return Estimate{0.0, 0.3};
  if (p.effect >= 0 && p.index > 0) return {};
  const auto& priors = p.effect >= 0 ? plan.effect_prior : plan.soil_prior;
  const auto found = priors.find(p.effect >= 0 ? p.effect : p.index);
  if (found == priors.end()) return {};
  Estimate prior = found->second;
  if (isLogStiffness(p) && plan.prior_modulus)
    prior.value -= std::log(modulusOf(model.soil) / *plan.prior_modulus);
  return prior;
}

FitPlan fitPlan(const RefinedModel& model, bool fit_soil) {
  FitPlan plan;
  const auto& all = soilParameters();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto vague = vagueSoil().find(all[k].name);
    const auto stated = model.soil_prior_std.find(all[k].name);
    if (fit_soil && vague != vagueSoil().end())
      plan.soil_prior[static_cast<int>(k)] = vague->second;
    else if (stated != model.soil_prior_std.end() && stated->second > 0.0)
      plan.soil_prior[static_cast<int>(k)] = {model.soil_prior_mean.at(all[k].name), stated->second};
    else
      continue;
    plan.free.push_back({-1, static_cast<int>(k)});
  }
  constexpr double kTypicalSizes = 50.0;  // (T25)
  for (std::size_t k = 0; k < model.effects.size(); ++k) {
    const int effect = static_cast<int>(k);
    const std::vector<FittedParameter> own = parametersOf(model, effect);
    plan.free.insert(plan.free.end(), own.begin(), own.end());
    if (own.empty() || model.effects[k].empirical()) continue;
    const EffectParameter& first = findEffect(model.effects[k].name)->parameters.front();
    if (first.low <= 0.0 && first.high >= 0.0)
      plan.effect_prior[effect] = {0.0, kTypicalSizes * std::abs(first.typical)};
  }
  return plan;
}

void giveVaguePrior(RefinedModel& model) {
  model.soil_prior_mean.clear();
  model.soil_prior_std.clear();
  for (const auto& [name, prior] : vagueSoil()) {
    model.soil_prior_mean[name] = prior.value;
    model.soil_prior_std[name] = prior.std;
  }
}

void giveDefaultDeviations(RefinedModel& model) {
  if (!model.soil_prior_std.empty() || model.base != BaseModel::WongReece) return;
  for (const SoilParameter& p : soilParameters()) {
    const auto vague = vagueSoil().find(p.name);
    if (vague == vagueSoil().end()) continue;
    model.soil_prior_mean[p.name] = p.get(model.soil);
    model.soil_prior_std[p.name] = 0.5 * vague->second.std;
  }
}

double misfitOf(const Eigen::VectorXd& white, const Trial& trial) {
  const auto readings = static_cast<double>(trial.measured.array().isFinite().count());
  return std::max(1.0, white.squaredNorm() / std::max(readings, 1.0));  // (T22)
}

std::vector<FittedParameter> parametersOf(const RefinedModel& model, int effect) {
  const Effect& e = model.effects[static_cast<std::size_t>(effect)];
  const EffectForm* form = findEffect(e.name);
  std::vector<FittedParameter> all;
  for (std::size_t k = 0; k < e.parameters.size(); ++k)
    if (!form || form->parameters[k].fitted) all.push_back({effect, static_cast<int>(k)});
  return all;
}

ParameterRange rangeOf(const RefinedModel& model, const FittedParameter& p) {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.effect < 0) {
    const SoilParameter& s = soilParameters()[index];
    return {s.low, s.high, s.scale};
  }
  const Effect& effect = model.effects[static_cast<std::size_t>(p.effect)];
  const EffectForm* form = findEffect(effect.name);
  if (!form) return {-10.0, 10.0, 0.05};
  const EffectParameter& e = form->parameters[index];
  const double size = std::max(std::abs(e.typical), 0.3 * std::abs(effect.parameters[index]));
  return {e.low, e.high, size > 0.0 ? 0.5 * size : 0.5};
}

Eigen::MatrixXd jacobian(const RefinedModel& model, const Trial& trial,
                         const std::vector<FittedParameter>& free, SolvedContacts& solved,
                         const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& scale) {
  const Eigen::MatrixXd here = predictRows(model, trial, solved);
  Eigen::MatrixXd j(here.rows() * kChannels, static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const ParameterRange range = rangeOf(model, free[k]);
    double h = 0.02 * range.scale;
    if (value(model, free[k]) + h > range.high) h = -h;
    RefinedModel moved = model;
    setValue(moved, free[k], value(model, free[k]) + h);
    SolvedContacts beside = solved;
    j.col(static_cast<Eigen::Index>(k)) = scale((predictRows(moved, trial, beside) - here) / h);
  }
  // A missing measurement has derivative 0.
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      if (!std::isfinite(trial.measured(row, c))) j.row(row * kChannels + c).setZero();
  return j;
}

Fit fitModel(const RefinedModel& start, const Trial& trial, const Whitening& whitening, const FitPlan& plan,
             SolvedContacts& solved) {
  FitPoint search{start, trial, whitening, plan, solved};
  const auto n = static_cast<Eigen::Index>(plan.free.size());
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd gradient(n);
  double damping = 1e-3;
  for (int iteration = 0; n > 0 && iteration < plan.iterations; ++iteration) {
    search.linearise(normal, gradient);
    const double before = search.cost();
    bool moved = false;
    for (int attempt = 0; attempt < 6 && !moved; ++attempt, damping *= moved ? 1.0 : 8.0) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += damping * normal.diagonal() + Eigen::VectorXd::Constant(n, 1e-9);
      moved = search.tryStep(search.stepInside(damped, gradient));
    }
    damping = std::max(1e-6, damping * 0.2);
    if (!moved || before - search.cost() < 1e-3 + 1e-5 * before) break;
  }
  return {.model = search.model(), .chi2 = search.chi2(), .prior_chi2 = search.priorChi2()};
}

Eigen::MatrixXd parameterCovariance(const RefinedModel& fitted, const Trial& trial,
                                    const Whitening& whitening, const FitPlan& plan, SolvedContacts& solved) {
  FitPoint search{fitted, trial, whitening, plan, solved};
  const auto n = static_cast<Eigen::Index>(plan.free.size());
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd gradient(n);
  search.linearise(normal, gradient);
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd s = search.scales();
  // (T24)
  return plan.misfit * s.asDiagonal() * normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n)) * s.asDiagonal();
}

namespace {

/// Standard deviation of the step of a parameter without a prior, in units of its scale.
constexpr double kVague = 100.0;

/// Prior standard deviation of a curve's values, as in priorOf().
constexpr double kCurveStd = 0.3;

Eigen::VectorXd change(const RefinedModel& moved, const ModelOnRows& at) {
  SolvedContacts solved = at.solved;
  return at.whitening.rowByRow(predictRows(moved, at.trial, solved) - at.level);
}

Eigen::VectorXd whole(const Trial& trial, Eigen::VectorXd column) {
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      if (!std::isfinite(trial.measured(row, c))) column[row * kChannels + c] = 0.0;
  return column.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

/// True if the first parameter of a form only allows one sign of the effect: a number or depth >= 0. A
/// factor, with the value 1 without effect, allows both signs.
bool isOneSided(const EffectParameter& first) {
  const bool is_factor = first.low > 0.0 && first.low < 1.0 && first.high > 1.0;
  return first.low >= 0.0 && !is_factor;
}

Contender libraryContender(const Candidate& candidate, const ModelOnRows& at) {
  const RefinedModel grown = withCandidate(at.model, candidate);
  std::vector<FittedParameter> free;
  for (std::size_t part = at.model.effects.size(); part < grown.effects.size(); ++part)
    for (const FittedParameter& p : parametersOf(grown, static_cast<int>(part))) free.push_back(p);
  const auto count = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(free.size()));
  const Eigen::VectorXd all = whole(at.trial, change(grown, at));  // (T27)
  Contender c;
  c.added.columns.resize(all.size(), count);
  c.added.columns.col(0) = all;
  c.added.prior = {Eigen::VectorXd::Zero(count), Eigen::VectorXd::Constant(count, 1.0 / (kVague * kVague))};
  if (free.empty()) c.added.prior = {Eigen::VectorXd::Ones(1), Eigen::VectorXd::Constant(1, 1e8)};
  constexpr double kStep = 0.05;
  for (std::size_t k = 1; k < free.size(); ++k) {
    RefinedModel moved = grown;
    setValue(moved, free[k], value(grown, free[k]) + kStep * rangeOf(grown, free[k]).scale);
    c.added.columns.col(static_cast<Eigen::Index>(k)) = (whole(at.trial, change(moved, at)) - all) / kStep;
  }
  c.positive = !free.empty() && isOneSided(findEffect(candidate.parts.front().name)->parameters.front());
  return c;
}

bool applies(const Effect& effect, const WheelState& state) {
  return effect.only_column.empty() || state.label(effect.only_column) == effect.only_value;
}

/// Whitened columns of one curve.
Eigen::MatrixXd curveColumns(const Effect& curve, const ModelOnRows& at) {
  Eigen::MatrixXd basis = splineBasis(covariateValues(at.trial, curve.covariate, at.sinkage_m), curve.knots);
  for (int row = 0; row < at.trial.rows(); ++row)
    if (!applies(curve, at.trial.states[static_cast<std::size_t>(row)])) basis.row(row).setZero();
  // All knots of a curve that changes the soil change the same number; one derivative therefore gives every
  // column.
  Eigen::MatrixXd by_value = Eigen::MatrixXd::Zero(at.trial.rows(), kChannels);
  if (curve.name == "empirical") {
    for (int row = 0; row < at.trial.rows(); ++row)
      by_value(row, static_cast<int>(curve.channel)) =
          curve.sense(at.trial.states[static_cast<std::size_t>(row)].slip_angle_rad);
  } else {
    constexpr double kStep = 0.02;
    Effect level = curve;
    level.only_column.clear();
    level.knots = {0.0};
    level.parameters = {kStep};
    RefinedModel moved = at.model;
    moved.effects.push_back(level);
    SolvedContacts solved = at.solved;
    by_value = (predictRows(moved, at.trial, solved) - at.level) / kStep;
  }
  Eigen::MatrixXd columns(at.trial.rows() * kChannels, basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k)
    // (T28)
    columns.col(k) = whole(at.trial, at.whitening.rowByRow(basis.col(k).asDiagonal() * by_value));
  return columns;
}

}  // namespace

RefinedModel withCandidate(const RefinedModel& model, const Candidate& candidate) {
  RefinedModel grown = model;
  for (const Effect& part : candidate.parts) grown.effects.push_back(part);
  return grown;
}

Contender contenderOf(const Candidate& candidate, const ModelOnRows& at) {
  Contender c;
  if (!candidate.empirical()) {
    c = libraryContender(candidate, at);
    c.log_prior = candidate.logPrior();
    return c;
  }
  c.log_prior = candidate.logPrior();
  c.added.columns.resize(at.trial.rows() * kChannels, 0);
  for (const Effect& curve : candidate.parts) {
    const Eigen::MatrixXd own = curveColumns(curve, at);
    c.added.columns.conservativeResize(Eigen::NoChange, c.added.columns.cols() + own.cols());
    c.added.columns.rightCols(own.cols()) = own;
  }
  const Eigen::Index count = c.added.columns.cols();
  c.added.prior = {Eigen::VectorXd::Zero(count),
                   Eigen::VectorXd::Constant(count, 1.0 / (kCurveStd * kCurveStd))};
  return c;
}

LinearModel linearised(const RefinedModel& fitted, const Trial& trial, const Whitening& whitening,
                       const FitPlan& plan, SolvedContacts& solved) {
  LinearModel linear;
  linear.columns = jacobian(fitted, trial, plan.free, solved,
                            [&](const Eigen::MatrixXd& m) { return whitening.rowByRow(m); });
  const auto count = static_cast<Eigen::Index>(plan.free.size());
  linear.prior = {Eigen::VectorXd::Zero(count), Eigen::VectorXd::Constant(count, 1.0 / (kVague * kVague))};
  for (Eigen::Index k = 0; k < count; ++k) {
    const FittedParameter& p = plan.free[static_cast<std::size_t>(k)];
    const double scale = rangeOf(fitted, p).scale;
    linear.columns.col(k) *= scale;
    const auto prior = priorOf(fitted, plan, static_cast<std::size_t>(k));
    if (!prior) continue;
    // value() returns 0 for log_stiffness, whose prior is a step from the model's current value.
    linear.prior.mean[k] = (prior->value - value(fitted, p)) / scale;
    linear.prior.precision[k] = scale * scale / (prior->std * prior->std);  // (T26)
  }
  return linear;
}

}  // namespace talus::terramech
