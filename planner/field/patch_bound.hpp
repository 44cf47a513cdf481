#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner {

/// Lower bound of the cost to go from any cell after an area of the map changed, computed from the field
/// before the change. The bound is admissible, so A* with this bound finds the cheapest path. Ours, not from
/// the literature.
///
/// A box around the change contains every changed step and is settled from its rim inwards. A rim cell keeps
/// its old cost, or improves by a path through the box, or improves by a path that leaves the box and enters
/// again elsewhere. Such an excursion costs at least the drop of the old field and at least its number of
/// steps times the cheapest edge. A cell outside the box keeps its old cost, or its path crosses the rim. In
/// the second case the cell improves by at most the largest improvement on the rim, and its cost is at least
/// the lowest cost of an improved rim cell.
class PatchBound {
 public:
  /// `before` is the field before the change; its edge layer is already updated. The bound refers to
  /// `before`, which must outlive the bound.
  PatchBound(const CostToGo& before, CellBox changed);

  /// False if the change connects cells that had no path before; no bound exists then.
  bool holds() const noexcept { return holds_; }

  /// Returns a lower bound in units, by padded index; kUnreached if no path exists.
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
