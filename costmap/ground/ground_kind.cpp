#include <algorithm>
#include <cmath>

#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kPullStdUnit = 0.02;
constexpr double kSinkageStep = 0.1;
constexpr double kSame = 1e-6;  // of a step: what has been rounded stays
constexpr double kOctaveStep = 0.25;
constexpr double kMostOctaves = 8.0;
constexpr double kMostSteps = 1e6;

int bounded(double steps) {
  return static_cast<int>(std::clamp(steps, -kMostSteps, kMostSteps));
}

// Whole multiples of 2^level steps.
int stepsBelow(double value, double step, int level) {
  const int many = 1 << level;
  return bounded(std::floor(value / step / many + kSame)) * many;
}

int stepsAbove(double value, double step, int level) {
  return -stepsBelow(-value, step, level);
}

// Steps of the logarithm; less than half the unit counts as that.
int logStepsAbove(double value, int level) {
  const double octaves = std::log2(std::clamp(value / kPullStdUnit, 0.5, std::exp2(kMostOctaves)));
  return stepsAbove(octaves, kOctaveStep, level);
}

}  // namespace

GroundKind GroundKind::of(int class_index, int other_class, const GroundBelief& belief, int level) noexcept {
  return {.class_index = class_index,
          .other_class = other_class,
          .pull = stepsBelow(belief.pull.value, kPullStep, level),
          .pull_std = logStepsAbove(belief.pull.std, level),
          .sinkage = std::max(stepsAbove(belief.sinkage.value, kSinkageStep, level), 0)};
}

GroundBelief GroundKind::belief(const GroundClass& ground) const noexcept {
  const double std = kPullStdUnit * std::exp2(kOctaveStep * pull_std);
  return {.pull = {pull * kPullStep, std},
          .sinkage = {sinkage * kSinkageStep, std::min(std / ground.pull_std, 1.0) * ground.sinkage_std}};
}

bool noBetter(const GroundBelief& belief, const GroundBelief& than) noexcept {
  return belief.pull.value <= than.pull.value && belief.pull.std >= than.pull.std &&
         belief.sinkage.value >= than.sinkage.value;
}

}  // namespace talus::costmap
