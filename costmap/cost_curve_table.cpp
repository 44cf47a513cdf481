#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <talus/costmap/cost_curve_table.hpp>

namespace talus::costmap {
namespace {

constexpr double kPullStep = 0.02;
constexpr double kPullStdUnit = 0.02;
constexpr double kSinkageStep = 0.1;

int stepsOf(double value, double step) {
  return static_cast<int>(std::lround(value / step));
}

// Power of two of the unit that is nearest above: a doubt is never rounded down.
int octave(double value, double unit) {
  return std::clamp(static_cast<int>(std::ceil(std::log2(std::max(value, 1e-6) / unit))), -1, 4);
}

}  // namespace

CostCurveTable::CostCurveTable(std::shared_ptr<const GroundModel> model) : model_(std::move(model)) {
  const int classes = static_cast<int>(model_->parts().classes.size());
  for (int i = 0; i < classes; ++i) {
    priors_.push_back(model_->prior(i));
    grounds_.push_back(model_->ground(i, priors_.back()));
    categories_.emplace_back(*model_, priors_.back());
  }
}

CostCurveTable::Key CostCurveTable::rounded(int class_index, const GroundBelief& belief) noexcept {
  return {.class_index = class_index,
          .pull = stepsOf(belief.pull.value, kPullStep),
          .pull_std = octave(belief.pull.std, kPullStdUnit),
          .sinkage = stepsOf(belief.sinkage.value, kSinkageStep)};
}

std::uint8_t CostCurveTable::learned(int class_index, const GroundBelief& belief) {
  const Key key = rounded(class_index, belief);
  if (const auto known = numbers_.find(key); known != numbers_.end()) return known->second;
  if (grounds_.size() >= CellCode::kUnknown) return nearest(key);
  // All of the key, so that a curve does not depend on who asked for it first; doubt about sinkage shrinks
  // with that about pull.
  const GroundClass& ground = model_->parts().classes[static_cast<std::size_t>(class_index)];
  const double pull_std = std::ldexp(kPullStdUnit, key.pull_std);
  const GroundBelief middle{.pull = {key.pull * kPullStep, pull_std},
                            .sinkage = {std::max(key.sinkage * kSinkageStep, 0.0),
                                        std::min(pull_std / ground.pull_std, 1.0) * ground.sinkage_std}};
  const auto number = static_cast<std::uint8_t>(grounds_.size());
  grounds_.push_back(model_->ground(class_index, middle));
  categories_.emplace_back(*model_, middle);
  numbers_.emplace(key, number);
  cost_.reset();
  return number;
}

std::uint8_t CostCurveTable::nearest(const Key& key) const noexcept {
  std::uint8_t best = prior(key.class_index);
  int least = std::numeric_limits<int>::max();
  for (const auto& [known, number] : numbers_) {
    const int distance = 4 * std::abs(known.pull - key.pull) + 2 * std::abs(known.pull_std - key.pull_std) +
                         3 * std::abs(known.sinkage - key.sinkage);
    if (known.class_index != key.class_index || distance >= least) continue;
    least = distance;
    best = number;
  }
  return best;
}

bool CostCurveTable::setPrior(int class_index, const GroundBelief& belief) {
  const auto i = static_cast<std::size_t>(class_index);
  const auto rounded_to = [](const Estimate& e, double step) {
    return Estimate{std::round(e.value / step) * step, std::ceil(e.std / step) * step};
  };
  const GroundBelief exact = model_->prior(class_index);
  const bool untouched = belief.pull.value == exact.pull.value && belief.pull.std == exact.pull.std;
  const GroundBelief next = untouched ? exact
                                      : GroundBelief{.pull = rounded_to(belief.pull, 0.005),
                                                     .sinkage = rounded_to(belief.sinkage, 0.02)};
  const auto same = [](const Estimate& a, const Estimate& b) { return a.value == b.value && a.std == b.std; };
  if (same(next.pull, priors_[i].pull) && same(next.sinkage, priors_[i].sinkage)) return false;
  priors_[i] = next;
  const Worked& now = worked(class_index, next);
  grounds_[i] = now.ground;
  categories_[i] = now.categories;
  cost_.reset();
  return true;
}

const CostCurveTable::Worked& CostCurveTable::worked(int class_index, const GroundBelief& prior) {
  constexpr std::size_t kRemembered = 64;
  const auto bits = [](double value) { return std::bit_cast<std::int64_t>(value); };
  const PriorKey key{class_index, bits(prior.pull.value), bits(prior.pull.std), bits(prior.sinkage.value),
                     bits(prior.sinkage.std)};
  if (const auto known = worked_.find(key); known != worked_.end()) return known->second;
  if (worked_.size() >= kRemembered) worked_.clear();
  return worked_.emplace(key, Worked{model_->ground(class_index, prior), CategoryTable(*model_, prior)})
      .first->second;
}

std::shared_ptr<const DriveCost> CostCurveTable::cost() const {
  if (!cost_) cost_ = std::make_shared<DriveCost>(model_->limits(), grounds_);
  return cost_;
}

}  // namespace talus::costmap
