#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::costmap {
namespace {

// P(value < bound) of a normal estimate; a step function for std = 0.
double probabilityBelow(const Estimate& value, double bound) {
  if (value.std <= 0.0) return value.value < bound ? 1.0 : 0.0;
  return terramech::normalProbability((bound - value.value) / value.std);
}

}  // namespace

GroundCategory::GroundCategory(const TravelPolicy& policy, const terramech::Rover& rover)
    : tan_margin_(std::tan(policy.slope_margin_rad)),
      critical_(policy.sinkage_critical > 0.0 ? policy.sinkage_critical
                                              : rover.clearance_m / rover.wheel.radius_m) {
  threshold_ = std::min(policy.sinkage_threshold, critical_);
}

// tan(slope -+ margin) by the addition theorem; infinite beyond a right angle.
GroundCategory::Edges GroundCategory::edges(double gradient) const noexcept {
  const double left = 1.0 - gradient * tan_margin_, right = 1.0 + gradient * tan_margin_;
  constexpr double kSteeper = std::numeric_limits<double>::infinity();
  return {.low = right > 0.0 ? (gradient - tan_margin_) / right : -kSteeper,
          .high = left > 0.0 ? (gradient + tan_margin_) / left : kSteeper};
}

terramech::Category GroundCategory::at(double pull, double sinkage, double gradient) const {
  const Edges edge = edges(gradient);
  return terramech::categorise(
      {.drawbar_pull_over_load = pull, .sinkage_over_radius = sinkage},
      {.dp_low = edge.low, .dp_high = edge.high, .z_threshold = threshold_, .z_critical = critical_});
}

RankedCategory GroundCategory::ranked(const GroundBelief& belief, double gradient) const {
  const Edges edge = edges(gradient);
  const double below_low = probabilityBelow(belief.pull, edge.low);
  const double below_high = probabilityBelow(belief.pull, edge.high);
  const double carried = probabilityBelow(belief.sinkage, threshold_);
  const double free = probabilityBelow(belief.sinkage, critical_);
  // Sums the probabilities of the combinations of pull and sinkage ranks that have the category of the mean.
  constexpr double kMost = std::numeric_limits<double>::infinity();
  const std::array<std::pair<double, double>, 3> pulls{
      {{kMost, 1.0 - below_high}, {gradient, below_high - below_low}, {-kMost, below_low}}};
  const std::array<std::pair<double, double>, 3> sinkages{
      {{-kMost, carried}, {threshold_, free - carried}, {kMost, 1.0 - free}}};
  const terramech::Category mean = at(belief.pull.value, belief.sinkage.value, gradient);
  double probability = 0.0;
  for (const auto& [pull, chance] : pulls)
    for (const auto& [sinkage, share] : sinkages)
      if (chance * share > 1e-9 && at(pull, sinkage, gradient) == mean) probability += chance * share;
  return {mean, probability};
}

}  // namespace talus::costmap
