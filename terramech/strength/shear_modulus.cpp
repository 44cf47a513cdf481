#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>

namespace talus::terramech {

namespace {

void require(std::size_t samples, std::size_t least) {
  if (samples >= least) return;
  throw std::domain_error("shear modulus: at least " + std::to_string(least) + " samples are required, got " +
                          std::to_string(samples));
}

bool atBound(double modulus, ModulusRange range) {
  return modulus < 1.001 * range.low_m || modulus > 0.999 * range.high_m;
}

// Pair (M3, M4) and the weight that makes the residual relative to the torque: 1/M4^2.
struct WeightedPair {
  StressPair pair;
  double weight;
};

WeightedPair torqueWeighted(const Wheel& wheel, const WheelSample& sample, double modulus) {
  const StressPair pair = linearOffset(wheel, sample, modulus).pair();
  return {.pair = pair, .weight = 1.0 / (pair.shear_Pa * pair.shear_Pa)};
}

double relativeTorqueError(const Wheel& wheel, std::span<const WheelSample> samples, double modulus) {
  MohrCoulombLine line;
  for (const WheelSample& s : samples) {
    const auto [pair, weight] = torqueWeighted(wheel, s, modulus);
    line.add(pair, weight);
  }
  return line.relativeResidual();
}

// globalMinimum() with progress and cancellation, for an error that is slow to evaluate with many samples.
template <class Error>
Minimum leastError(const Error& error, ModulusRange range, const ProgressMonitor& watch) {
  constexpr double kUsual = 85.0;  // usual number of evaluations
  double count = 0.0;
  const auto watched = [&](double k) {
    if (watch.stopped()) return 0.0;
    watch.report(std::min(1.0, ++count / kUsual));
    return error(k);
  };
  const Minimum least = globalMinimum(watched, range.low_m, range.high_m);
  watch.report(1.0);
  return least;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ModulusEstimate medianModulus(const std::vector<double>& values) {
  if (values.empty()) {
    throw std::domain_error(
        "shear modulus by effective torque: no sample has less slip and less torque per load than the sample "
        "of highest slip; vary the slip");
  }
  const double middle = median(values);
  std::vector<double> spread;
  for (const double v : values) spread.push_back(std::abs(v - middle));
  return {.shear_modulus_m = middle, .error = median(std::move(spread))};
}

const WheelSample& highestSlip(std::span<const WheelSample> samples) {
  require(samples.size(), 2);
  return *std::ranges::max_element(samples, {}, &WheelSample::slip);
}

double torquePerLoad(const WheelSample& s) {
  return s.torque_Nm / s.load_N;
}

// Bisection in log K: A(K)/A_max(K) falls from 1 at K = 0 to j/j_max.
std::optional<double> solveRatio(double ratio, double j, double j_max, ModulusRange range) {
  const auto excess = [&](double k) { return std::expm1(-j / k) / std::expm1(-j_max / k) - ratio; };
  double low = range.low_m;
  double high = range.high_m;
  if (!(excess(low) > 0.0) || !(excess(high) < 0.0)) return std::nullopt;
  while (high > low * (1.0 + 1e-12)) {
    const double middle = std::sqrt(low * high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

double modulusError_Pa(const Wheel& wheel, std::span<const WheelSample> samples, double shear_modulus_m) {
  std::vector<StressPair> points;
  MohrCoulombLine line;
  for (const WheelSample& s : samples) {
    points.push_back(linearOffset(wheel, s, shear_modulus_m).pair());
    line.add(points.back());
  }
  const ShearStrength fit = line.estimate();
  double sum = 0.0;
  for (const auto& [x, y] : points) sum += std::abs(y - fit.cohesion_Pa - fit.tan_friction * x);
  return sum / std::hypot(1.0, fit.tan_friction);
}

ModulusEstimate modulusByErrorMinimisation(const Wheel& wheel, std::span<const WheelSample> samples,
                                           ModulusRange range, const ProgressMonitor& watch) {
  require(samples.size(), 3);
  const Minimum best = leastError([&](double k) { return modulusError_Pa(wheel, samples, k); }, range, watch);
  return {.shear_modulus_m = best.at, .error = best.value, .at_bound = atBound(best.at, range)};
}

ModulusEstimate modulusByEffectiveTorque(const Wheel& wheel, std::span<const WheelSample> samples) {
  const WheelSample& fastest = highestSlip(samples);
  std::vector<double> values;
  for (const WheelSample& s : samples) {
    const double ratio = torquePerLoad(s) / torquePerLoad(fastest);
    const double j = peakShearDisplacement_m(wheel, s);
    if (s.slip < fastest.slip && ratio > 0.0 && ratio < 1.0 && j > 0.0)
      values.push_back(-j / std::log1p(-ratio));
  }
  return medianModulus(values);
}

ModulusEstimate modulusByTorqueRatio(const Wheel& wheel, std::span<const WheelSample> samples,
                                     ModulusRange range) {
  const WheelSample& fastest = highestSlip(samples);
  const double j_max = peakShearDisplacement_m(wheel, fastest);
  std::vector<double> values;
  for (const WheelSample& s : samples) {
    const double j = peakShearDisplacement_m(wheel, s);
    if (!(s.slip < fastest.slip) || !(j > 0.0)) continue;
    if (const auto k = solveRatio(torquePerLoad(s) / torquePerLoad(fastest), j, j_max, range))
      values.push_back(*k);
  }
  return medianModulus(values);
}

ModulusEstimate modulusJointly(const Wheel& wheel, std::span<const WheelSample> samples, ModulusRange range,
                               const ProgressMonitor& watch) {
  require(samples.size(), 4);
  const Minimum best =
      leastError([&](double k) { return relativeTorqueError(wheel, samples, k); }, range, watch);
  return {.shear_modulus_m = best.at, .error = best.value, .at_bound = atBound(best.at, range)};
}

namespace {

constexpr std::size_t kLeastSamples = 4;

bool byTorque(ModulusCriterion criterion) {
  return criterion == ModulusCriterion::EffectiveTorque || criterion == ModulusCriterion::TorqueRatio;
}

}  // namespace

ShearModulusGrid::ShearModulusGrid(const Wheel& wheel, const Options& options)
    : wheel_(wheel), options_(options) {
  const auto& [low, high] = options_.range;
  for (std::size_t i = 0; i < kValues; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kValues - 1);
    values_[i].modulus_m = low * std::pow(high / low, share);
  }
}

bool ShearModulusGrid::add(const WheelSample& sample) {
  const double displacement = peakShearDisplacement_m(wheel_, sample);
  if (!(sample.torque_Nm > 0.0) || !(displacement > 0.0)) return false;
  ++count_;
  if (byTorque(options_.criterion)) addTorque(sample, displacement);
  for (GridValue& rung : values_) {
    const StressPair own = options_.pair(wheel_, sample, rung.modulus_m);
    rung.method.add(own);
    if (byTorque(options_.criterion)) continue;
    const StressPair stresses =
        options_.pair == linearOffsetPair ? own : linearOffsetPair(wheel_, sample, rung.modulus_m);
    const bool joint = options_.criterion == ModulusCriterion::Joint;
    rung.line.add(stresses, joint ? 1.0 / squared(stresses.shear_Pa) : 1.0);
  }
  return true;
}

void ShearModulusGrid::addTorque(const WheelSample& sample, double displacement_m) {
  const double torque = sample.torque_Nm / sample.load_N;
  const bool fastest = sample.slip > fastest_slip_;
  torque_squares_ += squared(torque);
  if (fastest) fastest_slip_ = sample.slip, fastest_torque_ = torque;
  for (GridValue& rung : values_) {
    const double share = -std::expm1(-displacement_m / rung.modulus_m);
    rung.torque_share += torque * share;
    rung.share_squares += squared(share);
    if (fastest) rung.share_fastest = share;
  }
}

double ShearModulusGrid::squaredError(const GridValue& rung) const {
  const auto mean = [&](double sum) { return std::max(0.0, sum) / static_cast<double>(count_); };
  switch (options_.criterion) {
    case ModulusCriterion::Joint:
      return squared(rung.line.relativeResidual());
    case ModulusCriterion::ErrorMinimisation:
      return squared(rung.line.relativeResidual()) / (1.0 + squared(rung.line.estimate().tan_friction));
    // the sample at the highest slip is the reference and has no residual
    case ModulusCriterion::EffectiveTorque:
      return mean(torque_squares_ / squared(fastest_torque_) - 2.0 * rung.torque_share / fastest_torque_ +
                  rung.share_squares - squared(1.0 - rung.share_fastest));
    case ModulusCriterion::TorqueRatio:
      return mean(torque_squares_ - squared(rung.torque_share) / rung.share_squares);
  }
  return 0.0;
}

ShearModulusGrid::Place ShearModulusGrid::best() const {
  if (count_ < kLeastSamples) {
    throw std::domain_error("shear modulus: at least " + std::to_string(kLeastSamples) +
                            " samples are required, got " + std::to_string(count_));
  }
  std::array<double, kValues> error{};
  for (std::size_t i = 0; i < kValues; ++i) error[i] = squaredError(values_[i]);
  const auto i = static_cast<std::size_t>(std::ranges::min_element(error) - error.begin());
  if (i == 0 || i + 1 == kValues) return {.rung = i, .shift = 0.0};
  const double bend = error[i - 1] - 2.0 * error[i] + error[i + 1];
  return {.rung = i, .shift = bend > 0.0 ? 0.5 * (error[i - 1] - error[i + 1]) / bend : 0.0};
}

ModulusEstimate ShearModulusGrid::modulus() const {
  const auto [i, shift] = best();
  return {
      .shear_modulus_m = values_[i].modulus_m * std::pow(values_[1].modulus_m / values_[0].modulus_m, shift),
      .error = std::sqrt(squaredError(values_[i])),
      .at_bound = i == 0 || i + 1 == kValues};
}

ShearStrength ShearModulusGrid::strength() const {
  const auto [i, shift] = best();
  ShearStrength fit = values_[i].method.estimate();
  if (shift == 0.0) return fit;
  const ShearStrength next = values_[shift > 0.0 ? i + 1 : i - 1].method.estimate();
  const auto blend = [share = std::abs(shift)](const auto& a, const auto& b) {
    return (a + share * (b - a)).eval();
  };
  const auto both = [](const ShearStrength& f) { return Eigen::Vector2d(f.cohesion_Pa, f.tan_friction); };
  const Eigen::Vector2d between = blend(both(fit), both(next));
  fit.cohesion_Pa = between[0];
  fit.tan_friction = between[1];
  fit.covariance = blend(fit.covariance, next.covariance);
  fit.unseen = unseenStrength(fit);
  return fit;
}

}  // namespace talus::terramech
