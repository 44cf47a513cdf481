#include <algorithm>
#include <cmath>

#include <talus/costmap/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kPullStep = 0.02;
constexpr double kPullStdUnit = 0.02;
constexpr double kSinkageStep = 0.1;
constexpr double kSame = 1e-6;  // of a step: what has been rounded stays
constexpr int kMostOctave = 8;
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

int octavesAbove(double value, int level) {
  const double octave = std::log2(std::max(value, 1e-6) / kPullStdUnit);
  const int every = level < 2 ? 1 : 2;
  const int up = static_cast<int>(std::ceil(octave / every - kSame)) * every;
  return std::clamp(up, every == 1 ? -1 : 0, kMostOctave);
}

}  // namespace

GroundKind GroundKind::of(int class_index, int other_class, const GroundBelief& belief, int level) noexcept {
  return {.class_index = class_index,
          .other_class = other_class,
          .pull = stepsBelow(belief.pull.value, kPullStep, level),
          .pull_std = octavesAbove(belief.pull.std, level),
          .sinkage = std::max(stepsAbove(belief.sinkage.value, kSinkageStep, level), 0)};
}

GroundBelief GroundKind::belief(const GroundClass& ground) const noexcept {
  const double std = std::ldexp(kPullStdUnit, pull_std);
  return {.pull = {pull * kPullStep, std},
          .sinkage = {sinkage * kSinkageStep, std::min(std / ground.pull_std, 1.0) * ground.sinkage_std}};
}

bool noBetter(const GroundBelief& belief, const GroundBelief& than) noexcept {
  return belief.pull.value <= than.pull.value && belief.pull.std >= than.pull.std &&
         belief.sinkage.value >= than.sinkage.value;
}

}  // namespace talus::costmap
