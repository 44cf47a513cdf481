#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

// Keeps the fitted parameters marked in `keep`, with their rows and columns of the covariance.
void keepFitted(RefinedModel& model, const std::vector<char>& keep) {
  const std::size_t n = model.fitted.size();
  std::vector<FittedParameter> fitted;
  std::vector<double> covariance;
  for (std::size_t i = 0; i < n; ++i) {
    if (!keep[i]) continue;
    fitted.push_back(model.fitted[i]);
    for (std::size_t j = 0; j < n && !model.covariance.empty(); ++j) {
      if (keep[j]) covariance.push_back(model.covariance[i * n + j]);
    }
  }
  model.fitted = std::move(fitted);
  model.covariance = std::move(covariance);
}

void dropSensorFaults(RefinedModel& model) {
  std::vector<int> place;  // new index of each effect; -1: removed
  std::vector<Effect> left;
  for (const Effect& effect : model.effects) {
    const bool fault = isSensorFault(effect);
    place.push_back(fault ? -1 : static_cast<int>(left.size()));
    if (!fault) left.push_back(effect);
  }
  std::vector<char> keep;
  for (FittedParameter& p : model.fitted) {
    const int at = p.effect < 0 ? p.effect : place[static_cast<std::size_t>(p.effect)];
    keep.push_back(p.effect < 0 || at >= 0);
    p.effect = at;
  }
  model.effects = std::move(left);
  keepFitted(model, keep);
}

void takePriorAsCovariance(RefinedModel& model) {
  const auto& parameters = soilParameters();
  std::vector<double> variances;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto std = model.soil_prior_std.find(parameters[k].name);
    if (std == model.soil_prior_std.end()) continue;
    model.fitted.push_back({.effect = -1, .index = static_cast<int>(k)});
    variances.push_back(std->second * std->second);
  }
  model.covariance.assign(variances.size() * variances.size(), 0.0);
  for (std::size_t k = 0; k < variances.size(); ++k)
    model.covariance[k * (variances.size() + 1)] = variances[k];
}

}  // namespace

bool isSensorFault(const Effect& effect) {
  const EffectForm* form = findEffect(effect.name);
  return form && form->of_sensor && form->read;
}

RefinedModel groundTruthOf(const RefinedModel& model) {
  RefinedModel truth = model;
  truth.noise.absolute = {};
  truth.noise.relative = {};
  if (truth.noise.slip_absolute == 0.0 && truth.noise.slip_relative == 0.0)
    truth.noise.slip_absolute = truth.stated.slip.value_or(0.0);
  if (truth.fitted.empty()) takePriorAsCovariance(truth);
  dropSensorFaults(truth);
  return truth;
}

ModelPull pullOf(const RefinedModel& truth, const WheelState& state) {
  RefinedModel here = truth;
  if (here.noise.load_relative == 0.0)
    here.noise.load_relative = here.stated.load_N.value_or(0.0) / state.load_N;
  const Prediction p = predictWithStd(here, state);
  const auto of = [&](Channel c) {
    return Estimate{p.mean.scaled(c), p.scaled_std[static_cast<std::size_t>(c)]};
  };
  return {.pull_over_load = of(Channel::DrawbarPull),
          .sinkage_over_radius = of(Channel::Sinkage),
          .torque_over_load_radius = p.mean.scaled(Channel::Torque)};
}

PullForecast forecastPull(const RefinedModel& truth, const WheelState& state, double reference_slip) {
  const RangeCheck range("pull forecast");
  range.above("reference_slip", reference_slip, 0.0);
  range.within("reference_slip", reference_slip, {0.0, 1.0});
  RefinedModel chosen = truth;
  chosen.noise.slip_absolute = chosen.noise.slip_relative = 0.0;
  WheelState at = state;
  at.slip = reference_slip;
  const ModelPull reference = pullOf(chosen, at);
  at.slip = kForecastSlips.front();
  for (const double slip : kForecastSlips) {
    WheelState next = state;
    next.slip = slip;
    const auto pull = [&](const WheelState& s) { return predict(chosen, s).scaled(Channel::DrawbarPull); };
    if (pull(next) > pull(at)) at = next;
  }
  const Estimate most = pullOf(chosen, at).pull_over_load;
  return {.at_reference = reference.pull_over_load,
          .most = most,
          .most_slip = at.slip,
          .sinkage_over_radius = reference.sinkage_over_radius,
          .climbable_slope_rad = climbableSlope_rad(most)};
}

const std::vector<std::string>& pullFormulas() {
  static const std::vector<std::string> names{"single-force", "small-angle", "triangular", "plane"};
  return names;
}

Estimate pullOverLoadBy(const std::string& formula, const Wheel& wheel, const WheelSample& sample,
                        const ReadingErrors& errors) {
  const Estimate ours = pullOverLoad(wheel, sample, errors);
  if (formula == "single-force") return ours;
  if (formula == "small-angle") return {pullAtSmallAngle(wheel, sample), std::hypot(ours.std, 0.013)};
  if (formula == "triangular") return {pullOfTriangularStress(wheel, sample), std::hypot(ours.std, 0.014)};
  if (formula == "plane") return {kThesisPlane.at(wheel, sample), std::hypot(ours.std, 0.028)};
  throw std::invalid_argument("formula '" + formula +
                              "' is unknown, must be single-force, small-angle, triangular or plane");
}

namespace {

// Smallest variances of cohesion c and tan(phi), (1 Pa)^2 and (1e-4)^2: readings without scatter would have
// variances of 0.
const Eigen::Vector2d kLeastVariance(1.0, 1e-8);

struct Component {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
  double log_weight;
};

// Kalman update of a prior by the fit, and log N(fit; prior mean, sum of both covariances).
Component update(const StrengthPrior& prior, const Eigen::Vector2d& fit, const Eigen::Matrix2d& scatter) {
  const Eigen::Matrix2d sum = prior.covariance + scatter;
  const Eigen::Matrix2d gain = prior.covariance * sum.inverse();
  const Eigen::Vector2d away = fit - prior.mean;
  return {.mean = prior.mean + gain * away,
          .covariance = prior.covariance - gain * prior.covariance,
          .log_weight = std::log(prior.probability) -
                        0.5 * (away.dot(sum.inverse() * away) + std::log(sum.determinant()))};
}

}  // namespace

StrengthPrior strengthPrior(const SoilPrior& soil) {
  const double cosine = std::cos(soil.mean.friction_angle_rad);
  const Eigen::Vector2d std(soil.deviation.cohesion_Pa,
                            soil.deviation.friction_angle_rad / (cosine * cosine));
  return {.mean = {soil.mean.cohesion_Pa, std::tan(soil.mean.friction_angle_rad)},
          .covariance = std.cwiseAbs2().asDiagonal()};
}

ShearStrength withPrior(const ShearStrength& fit, std::span<const StrengthPrior> priors) {
  if (priors.empty()) throw std::invalid_argument("strength prior: no kind of soil");
  if (!fit.covariance.allFinite()) {
    throw std::domain_error(
        "strength prior: at least three samples are required to estimate the scatter about the line");
  }
  const Eigen::Vector2d reading(fit.cohesion_Pa, fit.tan_friction);
  const Eigen::Matrix2d scatter = fit.covariance + Eigen::Matrix2d(kLeastVariance.asDiagonal());
  std::vector<Component> parts;
  for (const StrengthPrior& prior : priors) parts.push_back(update(prior, reading, scatter));
  const double most = std::ranges::max_element(parts, {}, &Component::log_weight)->log_weight;
  double sum = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (const Component& part : parts) {
    const double weight = std::exp(part.log_weight - most);
    const Eigen::Vector2d away = part.mean - reading;  // relative to the fit, against cancellation
    sum += weight;
    mean += weight * away;
    squares += weight * (part.covariance + away * away.transpose());
  }
  mean /= sum;
  ShearStrength result = fit;
  result.cohesion_Pa = reading[0] + mean[0];
  result.tan_friction = reading[1] + mean[1];
  result.covariance = squares / sum - mean * mean.transpose();
  return result;
}

}  // namespace talus::terramech
