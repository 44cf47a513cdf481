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
  /// The field is the one before, its edge layer already updated. Both must outlive the bound.
  PatchBound(const CostToGo& before, CellBox changed);

  /// False where the change opens ground that had no way before: no bound is known then.
  bool holds() const noexcept { return holds_; }

  /// Units, by padded index; kUnreached where there is surely no way.
  std::uint32_t operator()(std::size_t index) const noexcept;

 private:
  struct RimCell {
    maps::Cell cell;
    std::uint32_t before;  // no more than its cost before the change
    bool exact;            // it is its cost
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
  std::uint32_t gain_ = 0;                      // the best of the rim
  std::uint32_t least_ = CostToGo::kUnreached;  // on the rim where it gains
  bool holds_ = true;
};

}  // namespace talus::planner
