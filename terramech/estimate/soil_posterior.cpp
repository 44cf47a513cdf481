#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

// Probability below which classes are not sampled.
constexpr double kNegligible = 1e-6;

// Number of samples up to which the mode of Gauss-Newton suffices; Gauss-Newton neglects the gradient of the
// normalisation.
constexpr std::size_t kFew = 20;

// Replaces log weights by weights with sum 1.
void normalise(std::vector<double>& log_weights) {
  const double most = *std::ranges::max_element(log_weights);
  double sum = 0.0;
  for (double& w : log_weights) sum += w = std::exp(w - most);
  for (double& w : log_weights) w /= sum;
}

void draw(const ClassFit& fit, int index, std::span<const WheelReading> samples,
          const Eigen::MatrixXd& points, std::vector<SoilDraw>& draws, std::vector<double>& log_weights) {
  const SoilClass& soil = fit.objective.soilClass();
  const TruncatedGaussian sampler = proposal(soil, fit.mode.likelihood);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const auto [y, log_density] = sampler.draw(points.col(k));
    const double cost = fit.objective.cost(y, samples, fit.before) + priorCost(soil, y);
    draws.push_back({.soil = soil.at(y), .soil_class = index});
    log_weights.push_back(std::log(soil.probability) - cost - log_density);
  }
}

SoilVector vectorOf(const ContactSoil& s) {
  return {s.cohesion_Pa, s.friction_angle_rad, s.sinkage_exponent, s.sinkage_modulus, s.shear_modulus_m};
}

// Pairs (value, weight) of the draws.
using Weighted = std::vector<std::pair<double, double>>;

// Weighted quantile; `sorted` ascending.
double quantile(const Weighted& sorted, double share) {
  double below = 0.0;
  for (const auto& [value, weight] : sorted) {
    if ((below += weight) >= share) return value;
  }
  return sorted.back().first;
}

CredibleInterval interval(const std::vector<SoilDraw>& draws, double ContactSoil::*field) {
  Weighted sorted;
  for (const SoilDraw& d : draws) sorted.emplace_back(d.soil.*field, d.weight);
  std::ranges::sort(sorted);
  return {quantile(sorted, 0.025), quantile(sorted, 0.975)};
}

double ellipse95(const SoilPosterior& p) {
  Weighted sorted;
  for (const SoilDraw& d : p.draws) sorted.emplace_back(strengthDistance(p, d.soil), d.weight);
  std::ranges::sort(sorted);
  return quantile(sorted, 0.95);
}

void summarise(SoilPosterior& p) {
  SoilVector mean = SoilVector::Zero();
  double squares = 0.0;
  for (const SoilDraw& d : p.draws) {
    mean += d.weight * vectorOf(d.soil);
    p.tan_friction += d.weight * std::tan(d.soil.friction_angle_rad);
    squares += d.weight * d.weight;
  }
  for (const SoilDraw& d : p.draws) {
    const SoilVector away = vectorOf(d.soil) - mean;
    const Eigen::Vector2d strength(away[kCohesion], std::tan(d.soil.friction_angle_rad) - p.tan_friction);
    p.covariance += d.weight * away * away.transpose();
    p.strength_covariance += d.weight * strength * strength.transpose();
  }
  const ContactSoil& likeliest = std::ranges::max_element(p.draws, {}, &SoilDraw::weight)->soil;
  p.mean = {mean[kCohesion], mean[kFriction], mean[kExponent], mean[kModulus],
            mean[kShear],    likeliest.c1,    likeliest.c2};
  p.effective_draws = 1.0 / squares;
  p.ellipse_95 = ellipse95(p);
  p.cohesion_Pa = interval(p.draws, &ContactSoil::cohesion_Pa);
  p.friction_angle_rad = interval(p.draws, &ContactSoil::friction_angle_rad);
  p.shear_modulus_m = interval(p.draws, &ContactSoil::shear_modulus_m);
}

// Prior variance of each parameter.
SoilVector priorVariance(const std::vector<ClassFit>& classes) {
  constexpr Eigen::Index kPoints = 256;
  const Eigen::MatrixXd points = evenPoints(kSoilParameters, kPoints);
  SoilVector sum = SoilVector::Zero();
  SoilVector squares = SoilVector::Zero();
  for (const ClassFit& fit : classes) {
    const SoilClass& soil = fit.objective.soilClass();
    for (Eigen::Index k = 0; k < kPoints; ++k) {
      SoilVector y = points.col(k);
      for (int p = 0; p < kSoilParameters; ++p) {
        if (!soil.parameters[static_cast<std::size_t>(p)].bounded()) y[p] = normalQuantile(y[p]);
      }
      const SoilVector value = vectorOf(soil.at(y));
      sum += soil.probability / kPoints * value;
      squares += soil.probability / kPoints * value.cwiseAbs2();
    }
  }
  return squares - sum.cwiseAbs2();
}

// Lists the parameters whose standard deviation the samples reduced by less than 10 %.
void listUndetermined(const SoilVector& before, SoilPosterior& p) {
  constexpr double kSeen = 0.9;
  const std::pair<ContactColumn, const char*> names[] = {
      {kCohesion, "cohesion_Pa: the posterior is almost as wide as the prior; vary the load"},
      {kFriction, "friction_angle_rad: the posterior is almost as wide as the prior; vary the load"},
      {kShear,
       "shear_modulus_m: the posterior is almost as wide as the prior; vary the slip, mainly at low slip"}};
  for (const auto& [column, text] : names) {
    if (before[column] > 0.0 && p.covariance(column, column) > kSeen * kSeen * before[column])
      p.unseen.emplace_back(text);
  }
}

void checkSample(const WheelReading& reading) {
  const auto& [wheel, s] = reading;
  validate(wheel);
  const RangeCheck range("soil fit");
  range.above("load_N", s.load_N, 0.0);
  range.finite("torque_Nm", s.torque_Nm);
  range.above("sinkage_m", s.sinkage_m, 0.0);
  range.within("sinkage_m", s.sinkage_m, {0.0, wheel.radius_m});
  range.within("slip", s.slip, {0.0, 1.0});
}

}  // namespace

double strengthDistance(const SoilPosterior& p, const ContactSoil& soil) {
  const Eigen::Vector2d away(soil.cohesion_Pa - p.mean.cohesion_Pa,
                             std::tan(soil.friction_angle_rad) - p.tan_friction);
  const Eigen::Vector2d std = p.strength_covariance.diagonal().cwiseSqrt();
  const Eigen::Array2d rounding = 1e-9 * Eigen::Array2d(p.mean.cohesion_Pa, p.tan_friction).abs();
  const Eigen::Vector2d scale = (std.array() > rounding).select(std.cwiseInverse(), 0.0);
  const Eigen::Matrix2d correlation = scale.asDiagonal() * p.strength_covariance * scale.asDiagonal();
  const Eigen::Vector2d scaled = scale.cwiseProduct(away);
  return scaled.dot(correlation.completeOrthogonalDecomposition().solve(scaled));
}

SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws) {
  SoilPosterior posterior;
  std::vector<double>& probabilities = posterior.class_probabilities;
  for (const ClassFit& fit : classes) {
    probabilities.push_back(std::log(fit.objective.soilClass().probability) + fit.mode.log_evidence);
  }
  const auto best = std::ranges::max_element(probabilities) - probabilities.begin();
  const ClassFit& likeliest = classes[static_cast<std::size_t>(best)];
  posterior.misfit = likeliest.objective.meanSquare(likeliest.mode.likelihood.at, samples);
  normalise(probabilities);
  const Eigen::MatrixXd points = evenPoints(kSoilParameters, draws);
  std::vector<double> weights;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    if (probabilities[k] > kNegligible)
      draw(classes[k], static_cast<int>(k), samples, points, posterior.draws, weights);
  }
  if (!std::ranges::any_of(weights, [](double w) { return std::isfinite(w); }))
    throw std::domain_error("soil fit: no soil of the prior can give these readings; check their units");
  normalise(weights);
  std::ranges::fill(probabilities, 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    posterior.draws[k].weight = weights[k];
    probabilities[static_cast<std::size_t>(posterior.draws[k].soil_class)] += weights[k];
  }
  summarise(posterior);
  listUndetermined(priorVariance(classes), posterior);
  return posterior;
}

void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options) {
  for (const WheelReading& s : samples) checkSample(s);
  const RangeCheck range("soil fit");
  range.within("outlier_share", options.outlier_share, {0.0, 0.5});
  range.atLeast("draws", options.draws, 16);
}

SoilPosterior fitSoil(std::span<const WheelReading> samples, const SoilMixture& prior,
                      const SoilFitOptions& options) {
  checkFit(samples, options);
  if (samples.empty() || prior.empty()) throw std::domain_error("soil fit: no sample, or no class of soil");
  StatePopulation population;
  for (const WheelReading& s : samples) population.add(s.sample, options.noise);
  std::vector<SoilObjective> classes;
  for (const SoilClass& soil : prior)
    classes.emplace_back(soil, SoilObjective::Setting{options.noise, options.outlier_share, population, {}});
  if (samples.size() > kFew) return fitManySamples(classes, samples, options);
  std::vector<ClassFit> fits;
  for (const SoilObjective& objective : classes) {
    fits.push_back({objective, {}, findModeAfresh(objective, samples)});
  }
  return samplePosterior(fits, samples, options.draws);
}

SoilPosterior fitSoil(const Wheel& wheel, std::span<const WheelSample> samples, const SoilMixture& prior,
                      const SoilFitOptions& options) {
  validate(wheel);
  std::vector<WheelReading> readings;
  for (const WheelSample& s : samples) readings.push_back({wheel, s});
  return fitSoil(readings, prior, options);
}

}  // namespace talus::terramech
