#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/LU>

#include <talus/terramech/estimate/strength_prior.hpp>

namespace talus::terramech {
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
