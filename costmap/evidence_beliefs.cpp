#include <array>
#include <memory>
#include <optional>

#include <talus/costmap/evidence_field.hpp>
#include <talus/costmap/evidence_store.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kMostRemembered = 512;  // patches

}  // namespace

// Of 8x8 blocks.
struct EvidenceField::Beliefs::Patch {
  LocalGround ground;
  std::array<std::optional<Belief>, kPatchBlocks * kPatchBlocks> known;
};

const EvidenceField::Belief& EvidenceField::Beliefs::away(int class_index) {
  auto known = away_.find(class_index);
  if (known == away_.end())
    known = away_.emplace(class_index, Belief{field_.classBelief(class_index), false}).first;
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
  if (patch == patches_.end())
    patch =
        patches_.emplace(key, std::make_shared<Patch>(Patch{field_.around(first, class_index), {}})).first;
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
        patch.ground, class_index,
        field_.store_->blocks.middleOf(field_.store_->blocks.blockAt(block.column, block.row)));
  return *known;
}

}  // namespace talus::costmap
