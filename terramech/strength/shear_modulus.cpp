#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>

namespace talus::terramech {

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
