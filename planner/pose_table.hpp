#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus::planner {

/// From a lattice key to the number of the best node found there. Grows by doubling; open addressing, since a
/// search asks it once a motion.
class PoseTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  PoseTable() : slots_(1U << 16) {}

  /// The number stored under the key, kNone when new; the reference is valid until the next call.
  std::uint32_t& operator[](std::uint64_t key) {
    if (2 * ++used_ > slots_.size()) grow();
    Slot& slot = find(key + 1);
    if (slot.key != 0) --used_;
    slot.key = key + 1;
    return slot.value;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;  // key + 1; 0 is empty
    std::uint32_t value = kNone;
  };

  Slot& find(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * 0x9e3779b97f4a7c15ULL >> 20) & mask;
    while (slots_[at].key != 0 && slots_[at].key != key) at = (at + 1) & mask;
    return slots_[at];
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != 0) find(slot.key) = slot;
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace talus::planner
