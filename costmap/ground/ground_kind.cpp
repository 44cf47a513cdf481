#include <algorithm>
#include <cmath>

#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kLeastStd = 0.01;  // least unit of the standard deviation, for priors with a smaller one
constexpr double kSinkageStep = 0.1;
constexpr double kSame = 1e-6;  // rounding tolerance [steps]: a quantised value remains equal
constexpr double kOctaveStep = 0.25;
constexpr double kLeastOctaves = -6.0, kMostOctaves = 8.0;
constexpr double kMostSteps = 1e6;

int bounded(double steps) {
  return static_cast<int>(std::clamp(steps, -kMostSteps, kMostSteps));
}

// Rounds down to a multiple of 2^level steps.
int stepsBelow(double value, double step, int level) {
  const int many = 1 << level;
  return bounded(std::floor(value / step / many + kSame)) * many;
}

int stepsAbove(double value, double step, int level) {
  return -stepsBelow(-value, step, level);
}

double unitOf(const GroundBelief& prior) noexcept {
  return std::max(prior.pull.std, kLeastStd);
}

// Returns log2(share), in steps, rounded up to a multiple of 2^level steps.
int logStepsAbove(double share, int level) {
  const double octaves = std::log2(std::clamp(share, std::exp2(kLeastOctaves), std::exp2(kMostOctaves)));
  return stepsAbove(octaves, kOctaveStep, level);
}

}  // namespace

GroundKind GroundKind::of(const GroundBelief& prior, int class_index, int other_class,
                          const GroundBelief& belief, int level) noexcept {
  return {
      .class_index = class_index,
      .other_class = other_class,
      .pull = stepsBelow(belief.pull.value - prior.pull.value, kPullStep, level),
      .pull_std = logStepsAbove(belief.pull.std / unitOf(prior), level),
      .sinkage = stepsAbove(std::max(belief.sinkage.value, 0.0) - prior.sinkage.value, kSinkageStep, level)};
}

GroundBelief GroundKind::belief(const GroundBelief& prior, const GroundClass& ground) const noexcept {
  const double std = unitOf(prior) * std::exp2(kOctaveStep * pull_std);
  return {.pull = {prior.pull.value + pull * kPullStep, std},
          .sinkage = {std::max(prior.sinkage.value + sinkage * kSinkageStep, 0.0),
                      std::min(std / ground.pull_std, 1.0) * ground.sinkage_std}};
}

}  // namespace talus::costmap
