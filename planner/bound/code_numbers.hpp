#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Consecutive numbers of cell codes whose gradient lies in the first eighth of the plane (0 <= dz/dy <= dz/dx), in
/// the order of their first request, so that data of codes can be stored in arrays. The numbers are in tables by
/// curve and gradient, because neighbouring cells have similar gradients. Not thread-safe.
class CodeNumbers {
 public:
  /// Returns the number of a code, which is size() before the call for a new code.
  std::uint32_t of(costmap::CellCode code) {
    std::vector<std::uint32_t>& table = tables_[code.curve()];
    // The gradient without an opposite is negative and may stand at either place.
    const auto [y, x] = std::minmax({std::abs(code.stepsX()), std::abs(code.stepsY())});
    const auto at = static_cast<std::size_t>(x * (x + 1) / 2 + y);
    if (at >= table.size()) table.resize(static_cast<std::size_t>((x + 1) * (x + 2) / 2), kNone);
    if (table[at] == kNone) table[at] = size_++;
    return table[at];
  }

  /// Returns the number of codes.
  std::uint32_t size() const noexcept { return size_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::vector<std::vector<std::uint32_t>> tables_ =
      std::vector<std::vector<std::uint32_t>>(std::size_t{costmap::CellCode::kBlocked} + 1);
  std::uint32_t size_ = 0;
};

}  // namespace talus::planner
