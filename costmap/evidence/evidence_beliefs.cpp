#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kMostRemembered = 512;  // patches

// Whether the place of a bound, anywhere in its block and as far off as it may be, lies in the block about `at`.
bool mayBeIn(const PlaceBound& bound, const maps::Point& at, double side_m) noexcept {
  const double gap_x_m = std::fmax(std::abs(at.x_m - bound.block.x_m) - side_m, 0.0);
  const double gap_y_m = std::fmax(std::abs(at.y_m - bound.block.y_m) - side_m, 0.0);
  const bool itself = at.x_m == bound.block.x_m && at.y_m == bound.block.y_m;
  return itself || std::hypot(gap_x_m, gap_y_m) < bound.reach_m;
}

GroundBelief bounded(const GroundBelief& belief, const PlaceBound& bound) noexcept {
  return weaker(belief, {.pull = {std::fmin(belief.pull.value, bound.most_pull), 0.0},
                         .sinkage = {std::fmax(belief.sinkage.value, bound.least_sinkage), 0.0}});
}

}  // namespace

// Of 8x8 blocks.
struct EvidenceField::Beliefs::Patch {
  LocalGround ground;
  std::array<std::optional<Belief>, kPatchBlocks * kPatchBlocks> known;
};

EvidenceField::Beliefs::Beliefs(const EvidenceField& field, Classes classes)
    : field_(field), states_(field.states(classes)) {}

EvidenceField::Beliefs::~Beliefs() = default;

const EvidenceField::Belief& EvidenceField::Beliefs::away(int class_index) {
  auto known = away_.find(class_index);
  if (known == away_.end())
    known = away_
                .emplace(class_index, Belief{field_.awayFromEvidence(
                                                 class_index, states_[static_cast<std::size_t>(class_index)]),
                                             false})
                .first;
  return known->second;
}

// Patches are forgotten when there are many, so that a whole map is worked out in little memory.
EvidenceField::Beliefs::Patch& EvidenceField::Beliefs::patchAt(const BlockLevel& block, int class_index) {
  BlockLevel first = block;
  first.column = block.column / kPatchBlocks * kPatchBlocks;
  first.row = block.row / kPatchBlocks * kPatchBlocks;
  const Key key{first.column, first.row, class_index};
  if (last_ && key == last_key_) return *last_;
  if (patches_.size() >= kMostRemembered) patches_.clear();
  auto patch = patches_.find(key);
  if (patch == patches_.end()) {
    const ClassState& state = states_[static_cast<std::size_t>(class_index)];
    patch =
        patches_.emplace(key, std::make_shared<Patch>(Patch{field_.around(first, class_index, state), {}}))
            .first;
  }
  last_key_ = key;
  return *(last_ = patch->second.get());
}

const EvidenceField::Belief& EvidenceField::Beliefs::at(maps::Cell cell, int class_index) {
  const BlockLevel block = field_.topOf(cell, class_index);
  Patch& patch = patchAt(block, class_index);
  if (patch.ground.empty()) return away(class_index);
  std::optional<Belief>& known = patch.known[static_cast<std::size_t>(
      block.row % kPatchBlocks * kPatchBlocks + block.column % kPatchBlocks)];
  if (!known)
    known = field_.believed(
        patch.ground, class_index, states_[static_cast<std::size_t>(class_index)],
        field_.store_->blocks.middleOf(field_.store_->blocks.blockAt(block.column, block.row)));
  return *known;
}

// Of a weak place as departures from a mean, with the doubt of the class as far as the place leaves it open.
GroundBelief EvidenceField::left(const GroundBelief& weak, const GroundBelief& mean, int class_index,
                                 double mean_std) const noexcept {
  const double open = std::min(weak.pull.std / groundOf(class_index).pull_std, 1.0);
  return {.pull = {mean.pull.value + weak.pull.value, std::hypot(weak.pull.std, open * mean_std)},
          .sinkage = {mean.sinkage.value + weak.sinkage.value, weak.sinkage.std}};
}

// No better than the class away from evidence until enough places say so, never better than any place that is weak
// leaves it, and within the bounds of the block itself. What no evidence reaches is left as its class to the bit.
EvidenceField::Belief EvidenceField::believed(const LocalGround& ground, int class_index,
                                              const ClassState& state, const maps::Point& at) const {
  const GroundBelief away = awayFromEvidence(class_index, state);
  const GroundBelief& prior = site_->model->prior(class_index);
  GroundBelief out = away;
  if (const auto learned = ground.process.learned(at); learned.any) {
    out = combined(class_index, state, learned);
    out.pull.std = std::min(out.pull.std, away.pull.std);
    if (state.may_raise)
      out.pull.value =
          std::min(out.pull.value, std::max(away.pull.value, prior.pull.value + state.most_rise));
    else
      out = weaker(out, away);
  }
  const Variation variation = variationOf(class_index);
  const double mean_std = groundOf(class_index).mean_std;
  for (const WeakPlace& place : ground.weak)
    if (const auto weak = weakness(place, variation, at)) {
      GroundBelief bound = left(*weak, prior, class_index, mean_std);
      if (!(place.pull < 0.0)) bound.pull = out.pull;  // it only sinks deeper
      out = weaker(out, bound);
    }
  // Ground that is ordinary for its class says no more than that it is no stronger: it leaves all ground as sure as it was.
  for (const WeakPlace& place : ground.lower)
    if (const auto weak = lowered(place, variation, at)) {
      GroundBelief bound = left(*weak, prior, class_index, state.pull_std);
      bound.pull.std = std::min(bound.pull.std, out.pull.std);
      bound.sinkage.std = std::min(bound.sinkage.std, out.sinkage.std);
      out = weaker(out, bound);
    }
  for (const PlaceBound& bound : ground.bounds)
    if (mayBeIn(bound, at, store_->blocks.side_m())) out = bounded(out, bound);
  return {out, out.pull.value != away.pull.value || out.pull.std != away.pull.std ||
                   out.sinkage.value != away.sinkage.value};
}

std::vector<ClassState> EvidenceField::states(Classes classes) const {
  std::vector<ClassState> all;
  for (int i = 0; i < static_cast<int>(store_->lessons.size()); ++i) all.push_back(stateOf(i, classes));
  return all;
}

ClassState EvidenceField::stateOf(int class_index, Classes classes) const {
  const ClassLessons& lessons = store_->lessons[static_cast<std::size_t>(class_index)];
  return classes == Classes::InSteps ? lessons.stateInSteps(site_->model->prior(class_index).pull.value)
                                     : lessons.state();
}

GroundBelief EvidenceField::classBelief(int class_index, Classes classes) const {
  return awayFromEvidence(class_index, stateOf(class_index, classes));
}

GroundBelief EvidenceField::awayFromEvidence(int class_index, const ClassState& state) const {
  const GroundClass& ground = groundOf(class_index);
  const GroundBelief prior = site_->model->prior(class_index);
  return {.pull = {prior.pull.value + state.pull, std::hypot(ground.pull_std, state.pull_std)},
          .sinkage = {std::max(prior.sinkage.value + state.sinkage, 0.0), ground.sinkage_std}};
}

// Doubt about the class as a whole counts as far as the place itself is not known, and the error that all readings
// share as far as their estimate rests on them, be it by the place's own or by its class's. A class mean that was
// rounded down may leave an estimate higher where the weights of its evidence exceed 1: by no more than is taken off.
GroundBelief EvidenceField::combined(int class_index, const ClassState& state,
                                     const LearnedPlace& learned) const {
  const GroundClass& ground = groundOf(class_index);
  const GroundBelief prior = site_->model->prior(class_index);
  const GroundBelief& departure = learned.departure;
  const double open = std::min(departure.pull.std / ground.pull_std, 1.0);
  const double own_std = std::hypot(departure.pull.std, open * state.own_std);
  const double variance =
      withSharedError({.prior = ground.pull_std * ground.pull_std + ground.mean_std * ground.mean_std,
                       .variance = own_std * own_std,
                       .shared = learned.shared + (1.0 - learned.weight) * state.shared});
  const double beyond = std::max(learned.positive - 1.0, 0.0);
  const double pull = departure.pull.value - beyond * state.pull_step;
  const double sinkage = departure.sinkage.value + beyond * state.sinkage_step;
  return {.pull = {prior.pull.value + state.pull + pull, std::sqrt(variance)},
          .sinkage = {std::max(prior.sinkage.value + state.sinkage + sinkage, 0.0), departure.sinkage.std}};
}

}  // namespace talus::costmap
