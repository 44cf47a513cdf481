#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

// Below this probability mass only the far tail remains, which is approximated by an exponential.
constexpr double kLeastMass = 1e-280;

// Truncated standard normal at fraction u of its probability mass, and the logarithm of its density.
struct Cut {
  double at;
  double log_density;
};

Cut tail(double low, double high, double u) {
  const double rate = -high;
  const double away = std::max(std::log(u) / rate, low - high);
  return {high + away, std::log(rate) + rate * away};
}

Cut cut(double low, double high, double u) {
  if (low > 0.0) {  // mirror to the lower tail, where the distribution function is accurate
    const Cut mirrored = cut(-high, -low, 1.0 - u);
    return {-mirrored.at, mirrored.log_density};
  }
  const double below = normalProbability(low);
  const double mass = normalProbability(high) - below;
  if (mass < kLeastMass) return tail(low, high, u);
  const double at = std::clamp(normalQuantile(std::clamp(below + u * mass, 1e-300, 1.0 - 1e-16)), low, high);
  return {at, -0.5 * at * at - 0.5 * std::log(2.0 * std::numbers::pi) - std::log(mass)};
}

}  // namespace

TruncatedGaussian::TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box)
    : mean_(mean), box_(box) {
  SoilMatrix left = covariance;  // conditional covariance given the coordinates drawn so far
  for (int turn = 0; turn < kSoilParameters; ++turn) {
    int widest = 0;
    left.diagonal().maxCoeff(&widest);
    order_[static_cast<std::size_t>(turn)] = widest;
    root_.col(turn) = left.col(widest) / std::sqrt(left(widest, widest));
    left -= root_.col(turn) * root_.col(turn).transpose();
    left.row(widest).setZero();
    left.col(widest).setZero();
    left(widest, widest) = -1.0;  // drawn
  }
}

TruncatedGaussian::Draw TruncatedGaussian::draw(const SoilVector& even) const {
  Draw draw{.at = mean_, .log_density = 0.0};
  for (int turn = 0; turn < kSoilParameters; ++turn) {
    const int k = order_[static_cast<std::size_t>(turn)];
    const double centre = draw.at[k];  // shifted by the coordinates drawn before
    const double scale = root_(k, turn);
    const auto [e, log_density] =
        cut((box_.low[k] - centre) / scale, (box_.high[k] - centre) / scale, even[turn]);
    draw.at += e * root_.col(turn);
    draw.log_density += log_density - std::log(scale);
  }
  return draw;
}

namespace {

Estimate logLoad(const WheelSample& sample, const ReadingErrors& errors) {
  return {.value = std::log(sample.load_N), .std = errors.load.std(sample.load_N) / sample.load_N};
}

}  // namespace

void StatePopulation::Spread::add(const Estimate& reading) {
  readings.add(reading.value, 0.0);
  error_variance += (reading.std * reading.std - error_variance) / readings.weight;
}

// Combines a reading with the population. V, the variance of the true values, is the variance of Student's
// predictive distribution of the readings minus the mean error variance.
Estimate StatePopulation::Spread::combine(const Estimate& reading) const {
  const double count = readings.weight, mean = readings.x;
  if (count <= 3.0) return reading;
  const double of_readings =
      readings.xx / (count - 1.0) * (count + 1.0) / count * (count - 1.0) / (count - 3.0);
  const double least = error_variance / count;
  const double variance = std::max(of_readings - error_variance, least);
  const double share = variance / (variance + reading.std * reading.std);
  return {.value = mean + share * (reading.value - mean), .std = std::sqrt(share) * reading.std};
}

void StatePopulation::add(const WheelSample& sample, const ReadingErrors& errors) {
  log_load_.add(logLoad(sample, errors));
  slip_.add({.value = sample.slip, .std = errors.slip.std(sample.slip)});
}

Estimate StatePopulation::load(const WheelSample& sample, const ReadingErrors& errors) const {
  const Estimate log_load = log_load_.combine(logLoad(sample, errors));
  const double load = std::exp(log_load.value);
  return {.value = load, .std = log_load.std * load};
}

Estimate StatePopulation::slip(const WheelSample& sample, const ReadingErrors& errors) const {
  const Estimate slip = slip_.combine({.value = sample.slip, .std = errors.slip.std(sample.slip)});
  return {.value = std::clamp(slip.value, 0.0, 1.0), .std = slip.std};
}

namespace {

constexpr double kOutlierScale = 10.0;  // standard deviation of an outlier, in units of the error
// Factor on the standard deviations of the proposal, so that its tails cover the posterior's.
constexpr double kWiden = 1.2;
constexpr int kMostPasses = 40;  // Gauss-Newton steps; 5 to 10 are usual

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
      d(kLoad, kSinkage) * sample.sinkage_m / f[kLoad];  // d ln W / d ln z: see soil_estimation.hpp
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
                                    const SoilQuadratic& before, Gradient gradient) const {
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
    if (gradient == Gradient::GaussNewton) {
      sum.gradient -= m.weight * m.derivative.transpose() * m.residual;
      continue;
    }
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
                  const SoilQuadratic& before, const SoilVector& start, SoilObjective::Gradient gradient) {
  const SoilClass& soil = objective.soilClass();
  struct Local {
    SoilQuadratic likelihood;
    double cost;
    SoilVector downhill;
    SoilMatrix information;
  };
  const auto at = [&](const SoilVector& x) {
    const SoilQuadratic q = objective.expand(coordinates(soil, x), samples, before, gradient);
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

SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples,
                        SoilObjective::Gradient gradient) {
  const SoilVector middle = SoilVector::Zero();
  const SoilMode near = findMode(objective, samples, {}, middle, gradient);
  const SoilVector start = findMode(objective.trusting(), samples, {}, middle, gradient).x;
  const SoilMode led = findMode(objective, samples, {}, start, gradient);
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

std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count) {
  if (samples.size() <= count) return {samples.begin(), samples.end()};
  std::vector<WheelReading> chosen;
  const double stretch = static_cast<double>(samples.size()) / static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {  // irregular places, against aliasing
    const double place = std::fmod(std::numbers::phi * static_cast<double>(k), 1.0);
    chosen.push_back(samples[static_cast<std::size_t>((static_cast<double>(k) + place) * stretch)]);
  }
  return chosen;
}

namespace {

using enum SoilObjective::Gradient;

constexpr std::size_t kFirst = 512;    // samples of the first search
constexpr std::size_t kGrowth = 16;    // growth factor of the number of samples per stage
constexpr std::size_t kWeighed = 300;  // up to this number of samples each draw is weighted with all of them
constexpr std::size_t kCurved = 1024;  // samples for the correction of the curvature
constexpr double kHopeless = 25.0;     // log probability below that of the best class at which a class is
                                       // excluded

// Difference between the curvature of the full cost and that of Gauss-Newton, which neglects that the
// covariance of a residual depends on the soil through the errors of z and i. The difference is computed from
// a subset and scaled to all samples.
SoilMatrix curvatureCorrection(const SoilObjective& objective, const SoilVector& y,
                               std::span<const WheelReading> samples) {
  constexpr double kStep = 1e-3;
  const std::vector<WheelReading> part = spreadEvenly(samples, kCurved);
  const auto expansion = [&](const SoilVector& at) { return objective.expand(at, part, {}, Whole); };
  SoilMatrix correction = -expansion(y).information;
  for (int k = 0; k < kSoilParameters; ++k) {
    const SoilVector step = kStep * SoilVector::Unit(k);
    const SoilVector column = (expansion(y + step).gradient - expansion(y - step).gradient) / (2.0 * kStep);
    correction.col(k) += 0.5 * column;
    correction.row(k) += 0.5 * column.transpose();
  }
  return static_cast<double>(samples.size()) / static_cast<double>(part.size()) * correction;
}

// First-order propagation of the errors of sinkage and slip causes an error of up to 2 % in friction angle
// and shear modulus for any number of samples. Above kTrusted samples the likelihood is therefore not
// sharpened further (ours; docs/measurements/terramech.md).
SoilQuadratic limitSharpness(SoilQuadratic q, std::size_t samples) {
  constexpr double kTrusted = 4000.0;
  const double share = std::min(1.0, kTrusted / static_cast<double>(samples));
  q.cost *= share;
  q.gradient *= share;
  q.information *= share;
  return q;
}

double logProbability(const ClassFit& fit) {
  return std::log(fit.objective.soilClass().probability) + fit.mode.log_evidence;
}

}  // namespace

std::span<const WheelReading> weighted(std::span<const WheelReading> samples) {
  return samples.size() <= kWeighed ? samples : std::span<const WheelReading>{};
}

std::vector<ClassFit> fitClasses(const std::vector<SoilObjective>& classes,
                                 std::span<const WheelReading> samples, const ProgressMonitor& watch) {
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  std::vector<ClassFit> fits;
  for (const SoilObjective& objective : classes) fits.push_back({objective, {}, {}});
  for (std::size_t count = kFirst; !watch.stopped(); count *= kGrowth) {
    const bool all = count >= samples.size();
    const std::vector<WheelReading> part = spreadEvenly(samples, count);
    double best = kNever, done = 0.0;
    for (ClassFit& fit : fits) {
      RoundProgress rounds;
      const auto report = [&](double share) {
        if (all) watch.report((done + rounds.at(share)) / static_cast<double>(fits.size()));
      };
      const SoilObjective watched = fit.objective.watchedBy({report, watch.stop});
      if (fit.mode.log_evidence > kNever)
        fit.mode = count == kFirst ? findModeAfresh(watched, part, Whole)
                                   : findMode(watched, part, {}, fit.mode.x, Whole);
      best = std::max(best, logProbability(fit));
      done += 1.0;
    }
    for (ClassFit& fit : fits)
      if (!(logProbability(fit) > best - kHopeless)) fit.mode.log_evidence = kNever;
    if (all) break;
  }
  if (watch.stopped()) return {};
  watch.report(1.0);
  for (ClassFit& fit : fits) {
    if (fit.mode.log_evidence == kNever) continue;
    SoilQuadratic& q = fit.mode.likelihood;
    const SoilMatrix whole = q.information + curvatureCorrection(fit.objective, q.at, samples);
    if ((whole + SoilMatrix::Identity()).llt().info() == Eigen::Success) q.information = whole;
    q = limitSharpness(q, samples.size());
    if (weighted(samples).empty()) fit.before = q;
  }
  return fits;
}

}  // namespace talus::terramech
