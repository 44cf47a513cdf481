#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace talus::planner {

/// Table of the lowest cost found at every cell and discrete heading. The headings of a cell are contiguous
/// in memory (a block), because a search reads neighbouring headings. A cell that was not reached needs four
/// bytes.
class PoseTable {
 public:
  PoseTable(std::size_t cells, std::size_t headings) : block_(cells, 0), headings_(headings) {
    costs_.resize(headings);  // block 0 belongs to no cell
  }

  /// Returns the cost at a cell index and heading index; infinite until set. The reference is valid until the
  /// next call.
  float& at(std::size_t cell, std::size_t heading) {
    std::uint32_t& block = block_[cell];
    if (block == 0) {
      block = static_cast<std::uint32_t>(costs_.size() / headings_);
      costs_.resize(costs_.size() + headings_, std::numeric_limits<float>::infinity());
    }
    return costs_[block * headings_ + heading];
  }

 private:
  std::vector<std::uint32_t> block_;  // index of the block of each cell; 0: no block
  std::size_t headings_;
  std::vector<float> costs_;
};

}  // namespace talus::planner
