#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner {

/// What is at least left to pay from any cell after part of a map changed, from the field before the change:
/// admissible, so a search that it leads finds the best way. Ours, not from the literature.
///
/// A box around the change holds every step that changed and is settled from its rim inwards. A cell of the
/// rim has its old cost, or gains by a way through the box, or by one that leaves the box and enters it again
/// elsewhere; such an excursion costs no less than what the old field drops by, nor than that many steps at
/// the cheapest. A cell outside pays its old cost, or comes by the rim: then it gains no more than the rim's
/// best gain, and pays no less than what is least on the rim where it gains.
class PatchBound {
 public:
  /// `before` is the field before the change; its edge layer is already updated. The bound refers to
  /// `before`, which must outlive the bound.
  PatchBound(const CostToGo& before, CellBox changed);

  /// False if the change connects cells that had no path before; no bound exists then.
  bool holds() const noexcept { return holds_; }

  /// Lower bound in units, by padded index; kUnreached if no path exists.
  std::uint32_t operator()(std::size_t index) const noexcept;

 private:
  struct RimCell {
    maps::Cell cell;
    std::uint32_t before;  // lower bound of the cost before the change
    bool exact;            // true if `before` is the cost itself
  };

  std::size_t local(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row - box_.first.row) * columns_ +
           static_cast<std::size_t>(c.column - box_.first.column);
  }
  void settleInwards(const std::vector<RimCell>& rim);
  std::vector<RimCell> rim() const;

  const CostToGo& before_;
  CellBox box_;
  std::size_t columns_;
  std::size_t first_index_, last_index_;        // padded
  std::vector<std::uint32_t> inside_;           // by local index
  std::uint32_t gain_ = 0;                      // largest improvement on the rim
  std::uint32_t least_ = CostToGo::kUnreached;  // lowest cost of an improved rim cell
  bool holds_ = true;
};

}  // namespace talus::planner
