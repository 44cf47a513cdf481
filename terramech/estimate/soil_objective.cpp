#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <talus/common/constants.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace {

constexpr double kOutlierScale = 10.0;  // standard deviation of an outlier, in units of the error
constexpr int kMostPasses = 40;         // Gauss-Newton steps; 5 to 10 are usual
// Factor on the standard deviations of the proposal, so that its tails cover the posterior's.
constexpr double kWiden = 1.2;

// The four readings with their errors; load and slip are combined with the population of all rows.
struct Readings {
  Readings(const SoilObjective::Setting& setting, const WheelSample& s)
      : load(setting.population.load(s, setting.noise)),
        torque{s.torque_Nm, setting.noise.torque.std(s.torque_Nm)},
        sinkage{s.sinkage_m, setting.noise.sinkage.std(s.sinkage_m)},
        slip(setting.population.slip(s, setting.noise)) {}

  ContactState state() const { return {.sinkage_m = sinkage.value, .slip = slip.value}; }
  Eigen::Vector2d residual(const ForceVector& f) const {
    return {load.value - f[kLoad], torque.value - f[kTorque]};
  }

  Estimate load, torque, sinkage, slip;
};

// Covariance of (W, T) given a soil and the readings of z and i.
Eigen::Matrix2d residualCovariance(const Readings& r, const ContactDerivative& d) {
  const Eigen::Matrix2d by_state = d.block<2, 2>(kLoad, kSinkage);
  const Eigen::Vector2d state(r.sinkage.std, r.slip.std);
  const Eigen::Vector2d reading(r.load.std, r.torque.std);
  const Eigen::Matrix2d carried = by_state * state.cwiseAbs2().asDiagonal() * by_state.transpose();
  return carried + Eigen::Matrix2d(reading.cwiseAbs2().asDiagonal());
}

// Robust loss -log[(1 - e) N(r; 1) + e N(r; 10)] relative to N(0; 1), and as weight twice its derivative by
// |r|^2.
void applyRobustLoss(double outlier_share, SampleMisfit& m) {
  const double square = m.residual.squaredNorm();
  const double scale2 = kOutlierScale * kOutlierScale;
  const double log_ratio =
      std::log(outlier_share / (1.0 - outlier_share) / scale2) + 0.5 * square * (1.0 - 1.0 / scale2);
  const double outlier = 1.0 / (1.0 + std::exp(-log_ratio));  // probability that the sample is an outlier
  m.weight = 1.0 - outlier * (1.0 - 1.0 / scale2);
  m.cost = 0.5 * square - std::log1p(-outlier_share) -
           (log_ratio > 30.0 ? log_ratio : std::log1p(std::exp(log_ratio)));
}

// Prior coordinate y(x) and its derivative: the standard normal distribution function for bounded parameters.
SoilVector coordinates(const SoilClass& soil, const SoilVector& x) {
  SoilVector y = x;
  for (int k = 0; k < kSoilParameters; ++k) {
    if (soil.parameters[static_cast<std::size_t>(k)].bounded()) y[k] = normalProbability(x[k]);
  }
  return y;
}

SoilVector coordinateSlope(const SoilClass& soil, const SoilVector& x) {
  SoilVector slope = SoilVector::Ones();
  for (int k = 0; k < kSoilParameters; ++k) {
    if (soil.parameters[static_cast<std::size_t>(k)].bounded()) slope[k] = normalDensity(x[k]);
  }
  return slope;
}

}  // namespace

SampleMisfit SoilObjective::misfit(const SoilVector& y, const WheelReading& reading) const {
  const auto& [wheel, sample] = reading;
  const Readings read(setting_, sample);
  ContactDerivative d;
  const ForceVector f = contactForces(soil_->at(y), wheel, read.state(), d);
  const Eigen::LLT<Eigen::Matrix2d> root(residualCovariance(read, d));
  SampleMisfit m;
  m.residual = root.matrixL().solve(read.residual(f));
  m.derivative = root.matrixL().solve(d.topLeftCorner<2, kSoilParameters>() * soil_->slope(y).asDiagonal());
  applyRobustLoss(setting_.outlier_share, m);
  const double stiffness =
      d(kLoad, kSinkage) * sample.sinkage_m / f[kLoad];  // d ln W / d ln z: see soil_posterior.hpp
  m.cost += std::log(root.matrixL()(0, 0) * root.matrixL()(1, 1) / stiffness);
  return m;
}

ContactState SoilObjective::likelyState(const ContactSoil& soil, const WheelReading& reading) const {
  const auto& [wheel, sample] = reading;
  const Readings read(setting_, sample);
  ContactDerivative d;
  const ForceVector f = contactForces(soil, wheel, read.state(), d);
  const Eigen::Vector2d variance(std::pow(read.sinkage.std, 2), std::pow(read.slip.std, 2));
  const Eigen::Matrix2d by_state = d.block<2, 2>(kLoad, kSinkage);
  const Eigen::Vector2d move = variance.asDiagonal() * by_state.transpose() *
                               residualCovariance(read, d).llt().solve(read.residual(f));
  return {.sinkage_m = std::clamp(sample.sinkage_m + move[0], 0.2 * sample.sinkage_m, 0.99 * wheel.radius_m),
          .slip = std::clamp(read.slip.value + move[1], 0.0, 1.0)};
}

double SoilQuadratic::costAt(const SoilVector& y) const {
  const SoilVector away = y - at;
  return cost + away.dot(gradient) + 0.5 * away.dot(information * away);
}

SoilQuadratic SoilQuadratic::movedTo(const SoilVector& y) const {
  return {.at = y, .cost = costAt(y), .gradient = gradientAt(y), .information = information};
}

SoilQuadratic SoilObjective::expand(const SoilVector& y, std::span<const WheelReading> samples,
                                    const SoilQuadratic& before) const {
  SoilQuadratic sum = before.movedTo(y);
  for (const WheelReading& r : samples) {
    const SampleMisfit m = misfit(y, r);
    sum.cost += m.cost;
    sum.gradient -= m.weight * m.derivative.transpose() * m.residual;
    sum.information += m.weight * m.derivative.transpose() * m.derivative;
  }
  return sum;
}

SoilQuadratic SoilObjective::expandWhole(const SoilVector& y, std::span<const WheelReading> samples,
                                         const SoilQuadratic& before) const {
  constexpr double kStep = 1e-6;
  constexpr std::size_t kBlock = 1024;
  SoilQuadratic sum = before.movedTo(y);
  for (std::size_t row = 0; row < samples.size(); ++row) {
    if (row % kBlock == 0 && row > 0) {
      if (setting_.watch.stopped()) break;
      setting_.watch.report(static_cast<double>(row) / static_cast<double>(samples.size()));
    }
    const SampleMisfit m = misfit(y, samples[row]);
    sum.cost += m.cost;
    sum.information += m.weight * m.derivative.transpose() * m.derivative;
    for (int k = 0; k < kSoilParameters; ++k)
      sum.gradient[k] += (misfit(y + kStep * SoilVector::Unit(k), samples[row]).cost - m.cost) / kStep;
  }
  return sum;
}

double SoilObjective::cost(const SoilVector& y, std::span<const WheelReading> samples,
                           const SoilQuadratic& before) const {
  double sum = before.costAt(y);
  for (const WheelReading& s : samples) sum += misfit(y, s).cost;
  return sum;
}

double SoilObjective::meanSquare(const SoilVector& y, std::span<const WheelReading> samples) const {
  double sum = 0.0;
  for (const WheelReading& r : samples) sum += misfit(y, r).residual.squaredNorm();
  return sum / (2.0 * static_cast<double>(samples.size()));
}

SoilMode findMode(const SoilObjective& objective, std::span<const WheelReading> samples,
                  const SoilQuadratic& before, const SoilVector& start) {
  const SoilClass& soil = objective.soilClass();
  struct Local {
    SoilQuadratic likelihood;
    double cost;
    SoilVector downhill;
    SoilMatrix information;
  };
  const auto at = [&](const SoilVector& x) {
    const SoilQuadratic q = objective.expand(coordinates(soil, x), samples, before);
    const SoilVector stretch = coordinateSlope(soil, x);
    return Local{
        q, q.cost + 0.5 * x.squaredNorm(), -x - stretch.cwiseProduct(q.gradient),
        SoilMatrix(stretch.asDiagonal() * q.information * stretch.asDiagonal()) + SoilMatrix::Identity()};
  };
  SoilVector x = start;
  Local here = at(x);
  double damping = 1e-3;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    SoilMatrix damped = here.information;
    damped.diagonal() *= 1.0 + damping;
    const SoilVector step = damped.llt().solve(here.downhill);
    const Local there = at(x + step);
    const double gain = here.cost - there.cost;
    damping *= gain > 0.0 ? 0.1 : 10.0;
    // The step direction neglects the slowly varying normalisation of the cost; a step with a small expected
    // gain is therefore not retried.
    const double promise = 0.5 * step.dot(here.downhill);
    if (std::abs(gain) < 1e-3 || (gain < 0.0 && promise < 1e-2)) break;
    if (gain > 0.0) x += step, here = there;
  }
  const double log_root = here.information.llt().matrixL().toDenseMatrix().diagonal().array().log().sum();
  return {.x = x, .likelihood = here.likelihood, .log_evidence = -here.cost - log_root};
}

SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples) {
  const SoilVector middle = SoilVector::Zero();
  const SoilMode near = findMode(objective, samples, {}, middle);
  const SoilMode led =
      findMode(objective, samples, {}, findMode(objective.trusting(), samples, {}, middle).x);
  return led.log_evidence > near.log_evidence ? led : near;
}

TruncatedGaussian proposal(const SoilClass& soil, const SoilQuadratic& likelihood) {
  SoilBox box{SoilVector::Constant(-kInfinity), SoilVector::Constant(kInfinity)};
  SoilMatrix information = likelihood.information;
  SoilVector gradient = likelihood.gradient;
  for (int k = 0; k < kSoilParameters; ++k) {
    information(k, k) +=
        1.0;  // Gaussian prior; for bounded parameters a regularisation, so that the matrix is invertible
    if (soil.parameters[static_cast<std::size_t>(k)].bounded()) {
      box.low[k] = 0.0;
      box.high[k] = 1.0;
    } else {
      gradient[k] += likelihood.at[k];
    }
  }
  const SoilMatrix covariance = information.inverse();
  return {likelihood.at - covariance * gradient, kWiden * kWiden * covariance, box};
}

double priorCost(const SoilClass& soil, const SoilVector& y) {
  double cost = 0.0;
  for (int k = 0; k < kSoilParameters; ++k) {
    if (soil.parameters[static_cast<std::size_t>(k)].bounded()) continue;
    cost += 0.5 * y[k] * y[k] + 0.5 * std::log(2.0 * std::numbers::pi);
  }
  return cost;
}

}  // namespace talus::terramech
