#include <cmath>

#include <talus/terramech/calibration/fit/candidate_columns.hpp>
#include <talus/terramech/calibration/noise/spline_basis.hpp>

namespace talus::terramech {
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
