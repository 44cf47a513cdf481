#include <algorithm>
#include <cmath>

#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kLeastStd = 0.01;  // least unit of the standard deviation, for priors with a smaller one
constexpr double kSinkageStep = 0.02;
constexpr double kSame = 1e-6;  // rounding tolerance [steps]: a quantised value remains equal
constexpr double kOctaveStep = 0.125;
constexpr double kLeastOctaves = -6.0, kMostOctaves = 8.0;
constexpr double kMostSteps = 1e6;

int bounded(double steps) {
  return static_cast<int>(std::clamp(steps, -kMostSteps, kMostSteps));
}

int stepsBelow(double value, double step) {
  return bounded(std::floor(value / step + kSame));
}

int stepsAbove(double value, double step) {
  return -stepsBelow(-value, step);
}

double unitOf(const GroundBelief& prior) noexcept {
  return std::max(prior.pull.std, kLeastStd);
}

// Returns log2(share), in steps, rounded up.
int logStepsAbove(double share) {
  const double octaves = std::log2(std::clamp(share, std::exp2(kLeastOctaves), std::exp2(kMostOctaves)));
  return stepsAbove(octaves, kOctaveStep);
}

}  // namespace

GroundKind GroundKind::of(const GroundBelief& prior, int class_index, int other_class,
                          const GroundBelief& belief) noexcept {
  return {.class_index = class_index,
          .other_class = other_class,
          .pull = stepsBelow(belief.pull.value - prior.pull.value, kPullStep),
          .pull_std = logStepsAbove(belief.pull.std / unitOf(prior)),
          .sinkage = stepsAbove(std::max(belief.sinkage.value, 0.0) - prior.sinkage.value, kSinkageStep)};
}

GroundBelief GroundKind::belief(const GroundBelief& prior, const GroundClass& ground) const noexcept {
  const double std = unitOf(prior) * std::exp2(kOctaveStep * pull_std);
  return {.pull = {prior.pull.value + pull * kPullStep, std},
          .sinkage = {std::max(prior.sinkage.value + sinkage * kSinkageStep, 0.0),
                      std::min(std / ground.pull_std, 1.0) * ground.sinkage_std}};
}

}  // namespace talus::costmap
