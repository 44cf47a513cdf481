#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

namespace {

constexpr int kPatchBlocks = EvidenceReach::kPatchBlocks;
constexpr std::size_t kMostNeighbours = 64;
constexpr double kDecision = 0.02;  // quantile over the hypotheses that decisions use

// True if the place of a bound may lie in the block around `at`: the place is anywhere in its block or within
// its position uncertainty around the block.
bool mayBeIn(const PlaceBound& bound, const maps::Point& at, double side_m) noexcept {
  const double gap_x_m = std::fmax(std::abs(at.x_m - bound.block.x_m) - side_m, 0.0);
  const double gap_y_m = std::fmax(std::abs(at.y_m - bound.block.y_m) - side_m, 0.0);
  const bool itself = at.x_m == bound.block.x_m && at.y_m == bound.block.y_m;
  return itself || std::hypot(gap_x_m, gap_y_m) < bound.reach_m;
}

// Estimate by one hypothesis.
struct Weighed {
  double weight = 0.0;
  Estimate pull;
};

// Returns the estimate at the quantile kDecision of the means.
Estimate decided(std::vector<Weighed> all) {
  std::ranges::stable_sort(all, {}, [](const Weighed& w) { return w.pull.value; });
  double below = 0.0;
  for (const Weighed& w : all)
    if ((below += w.weight) >= kDecision) return w.pull;
  return all.back().pull;
}

// Evidence of one block.
struct Block {
  maps::Point middle;
  std::vector<SourcePull> pulls;
  double sinkage = 0.0;  // departure of sinkage over radius from the class; NaN: not measured
};

// Readings of the sound sources of a hypothesis, each without the error of its source.
std::vector<PlaceEvidence> soundOf(const std::vector<Block>& blocks, const ClassHypothesis& h, double prior) {
  std::vector<PlaceEvidence> out;
  for (const Block& block : blocks) {
    SourcePull all;
    for (const SourcePull& one : block.pulls) {
      const auto sound =
          std::ranges::lower_bound(h.sound, one.source, {}, [](const auto& s) { return s.first; });
      if (sound == h.sound.end() || sound->first != one.source) continue;
      all.weight += one.weight;
      all.pull += one.weight * (one.pull - sound->second);
    }
    if (all.weight > 0.0)
      out.push_back({.place = block.middle,
                     .pull = all.pull / all.weight - prior - h.pull,
                     .sinkage = block.sinkage,
                     .variance = all.variance()});
  }
  return out;
}

}  // namespace

GroundBelief classGround(const GroundModel& model, const GroundOfClass& of) {
  const GroundClass& ground = model.parts().classes[static_cast<std::size_t>(of.class_index)];
  const GroundBelief prior = model.prior(of.class_index);
  std::vector<Weighed> all;
  for (const ClassHypothesis& h : of.state.hypotheses)
    all.push_back(
        {h.weight,
         {prior.pull.value + h.pull, std::hypot(ground.pull_std, std::hypot(h.own_std, h.shared_std))}});
  return {.pull = decided(std::move(all)),
          .sinkage = {std::max(prior.sinkage.value + of.state.sinkage, 0.0), ground.sinkage_std}};
}

// The process contains only places within a correlation length of the patch, of more than kMostNeighbours the
// nearest. Bounds, of any class, also lie beyond, if their position uncertainty reaches the patch.
LocalGround::LocalGround(const EvidenceStore& store, const BlockOfClass& patch, const GroundOfClass& of)
    : store_(store), of_(of) {
  const int near = store.blocks.reach();
  const int reach = near + static_cast<int>(std::ceil(store.reach.farthest_m() / store.blocks.side_m()));
  const GroundBelief& prior = store.model().prior(of.class_index);
  const int number = store.groundClass(of.class_index).number;
  std::vector<Block> blocks;
  store.visit(
      {{patch.column - reach, patch.row - reach},
       {patch.column + kPatchBlocks + reach - 1, patch.row + kPatchBlocks + reach - 1}},
      [&](const BlockOfClass& at, const BlockEvidence& e) {
        const maps::Point middle = store.blocks.middleOf(store.blocks.blockAt(at.column, at.row));
        const bool alike = at.terrain_class == number;
        if (const GroundBound bound = e.bound(); (alike || e.reach > 0) && bound.any())
          bounds_.push_back({middle, e.reach_m(), bound.most_pull, bound.least_sinkage});
        const auto isNear = [&](int block) { return block >= -near && block < kPatchBlocks + near; };
        std::vector<SourcePull> pulls = e.pulls();
        if (!alike || pulls.empty() || !isNear(at.column - patch.column) || !isNear(at.row - patch.row))
          return;
        const double sinkage = e.sinkage() - prior.sinkage.value - of.state.sinkage;
        blocks.push_back({middle, std::move(pulls),
                          e.sinkageVerified() || std::isnan(sinkage) ? sinkage : std::max(sinkage, 0.0)});
      });
  any_ = !blocks.empty() || !bounds_.empty();
  if (blocks.size() > kMostNeighbours) {
    const maps::Point low = store.blocks.middleOf(store.blocks.blockAt(patch.column, patch.row));
    const double half_m = 0.5 * (kPatchBlocks - 1) * store.blocks.side_m();
    std::ranges::stable_sort(blocks, {}, [&](const Block& b) {
      return std::max(std::abs(b.middle.x_m - low.x_m - half_m), std::abs(b.middle.y_m - low.y_m - half_m));
    });
    blocks.resize(kMostNeighbours);
  }
  const GroundClass& ground = store.groundClass(of.class_index);
  const Variation variation{ground.pull_std, ground.sinkage_std,
                            store.model().parts().policy.correlation_length_m};
  for (const ClassHypothesis& h : of.state.hypotheses) {
    std::vector<PlaceEvidence> places = soundOf(blocks, h, prior.pull.value);
    hypotheses_.push_back({h, places, GaussianProcess(places, variation)});
  }
}

InferredGround LocalGround::at(const maps::Point& at) const {
  const GroundBelief away = classGround(store_.model(), of_), prior = store_.model().prior(of_.class_index);
  InferredGround out{away};
  std::vector<Weighed> all;
  bool any = false;
  double sinkage = -std::numeric_limits<double>::infinity();
  for (const auto& [h, places, process] : hypotheses_) {
    const LearnedPlace learned = process.learned(at);
    any |= learned.any;
    const double mean = prior.pull.value + h.pull;
    const auto own = std::ranges::find(places, at, &PlaceEvidence::place);
    double other = 0.0;
    if (own != places.end()) {
      other = otherSoilProbability(own->pull - learned.departure.pull.value, own->variance);
      all.push_back({other * h.weight, {mean + own->pull, std::sqrt(own->variance)}});
    }
    all.push_back(
        {(1.0 - other) * h.weight,
         {mean + learned.departure.pull.value,
          std::hypot(learned.departure.pull.std, (1.0 - learned.weight) * h.own_std, h.shared_std)}});
    if (learned.departure.sinkage.value > sinkage) {
      sinkage = learned.departure.sinkage.value;
      out.ground.sinkage.std = learned.departure.sinkage.std;
    }
  }
  if (any) {
    out.ground.pull = decided(std::move(all));
    out.ground.sinkage.value = std::max(prior.sinkage.value + of_.state.sinkage + sinkage, 0.0);
  }
  for (const PlaceBound& bound : bounds_)
    if (mayBeIn(bound, at, store_.blocks.side_m())) {
      out.ground.pull.value = std::fmin(out.ground.pull.value, bound.most_pull);
      out.ground.sinkage.value = std::fmax(out.ground.sinkage.value, bound.least_sinkage);
    }
  out.learned = out.ground.pull.value != away.pull.value || out.ground.pull.std != away.pull.std ||
                out.ground.sinkage.value != away.sinkage.value;
  return out;
}

namespace {

constexpr std::size_t kMostRemembered = 512;  // greatest number of stored patches
constexpr int kPatchSide = EvidenceReach::kPatchBlocks;

}  // namespace

struct EvidenceBeliefs::Patch {
  LocalGround ground;
  std::array<std::optional<InferredGround>, kPatchSide * kPatchSide> known;
};

EvidenceBeliefs::EvidenceBeliefs(const EvidenceField& field)
    : store_(field.store()), states_(field.states()) {}

EvidenceBeliefs::~EvidenceBeliefs() = default;

GroundOfClass EvidenceBeliefs::groundOf(int class_index) const {
  return {class_index, states_[static_cast<std::size_t>(class_index)]};
}

const InferredGround& EvidenceBeliefs::away(int class_index) {
  auto known = away_.find(class_index);
  if (known == away_.end())
    known =
        away_.emplace(class_index, InferredGround{classGround(store_.model(), groundOf(class_index)), false})
            .first;
  return known->second;
}

// Returns the patch of a block and class, computed on first use. Discards all patches at kMostRemembered,
// which limits the memory for a whole map.
EvidenceBeliefs::Patch& EvidenceBeliefs::patchAt(const BlockOfClass& block, int class_index) {
  BlockOfClass first = block;
  first.column = block.column / kPatchSide * kPatchSide;
  first.row = block.row / kPatchSide * kPatchSide;
  const Key key{first.column, first.row, class_index};
  if (last_ && key == last_key_) return *last_;
  if (patches_.size() >= kMostRemembered) patches_.clear();
  auto patch = patches_.find(key);
  if (patch == patches_.end()) {
    LocalGround ground(store_, first, groundOf(class_index));
    patch = patches_.emplace(key, std::make_shared<Patch>(Patch{std::move(ground), {}})).first;
  }
  last_key_ = key;
  return *(last_ = patch->second.get());
}

const InferredGround& EvidenceBeliefs::at(maps::Cell cell, int class_index) {
  const BlockOfClass block = store_.topOf(cell, class_index);
  Patch& patch = patchAt(block, class_index);
  if (patch.ground.empty()) return away(class_index);
  std::optional<InferredGround>& known =
      patch.known[static_cast<std::size_t>(block.row % kPatchSide * kPatchSide + block.column % kPatchSide)];
  if (!known) known = patch.ground.at(store_.blocks.middleOf(store_.blocks.blockAt(block.column, block.row)));
  return *known;
}

}  // namespace talus::costmap
