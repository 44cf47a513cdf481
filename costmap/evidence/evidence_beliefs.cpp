#include <array>
#include <optional>
#include <utility>

#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>

namespace talus::costmap {
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
