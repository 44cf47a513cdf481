#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner {

/// Lower bound of the cost from any cell to the goal after a change in an area of the map, computed from the
/// cost-to-go field before the change. The bound is admissible; therefore A* with this bound finds the
/// cheapest path. Ours, not from the literature.
///
/// A box around the change contains every changed step. The cells of the box are settled from its rim
/// (outermost cells) inwards. A rim cell has its old cost, or it is cheaper by a path inside the box, or it
/// is cheaper by a path that leaves the box and enters it elsewhere. The part of such a path outside the box
/// costs at least the decrease of the old field along it, and at least its number of steps times the cheapest
/// step. A cell outside the box has its old cost, or its path crosses the rim. In the second case its cost
/// decreases by at most the largest decrease on the rim, and is at least the lowest cost of a rim cell whose
/// cost decreased.
class PatchBound {
 public:
  /// `before` is the field before the change, with its edge layer already updated. The field must outlive the
  /// bound.
  PatchBound(const CostToGo& before, CellBox changed);

  /// Returns false if no bound exists, because the change connects cells that had no path to the goal before.
  bool holds() const noexcept { return holds_; }

  /// Returns the lower bound, in units, for a padded index; kUnreached if there is no path.
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
  std::uint32_t gain_ = 0;                      // largest decrease of the cost on the rim
  std::uint32_t least_ = CostToGo::kUnreached;  // lowest cost of a rim cell whose cost decreased
  bool holds_ = true;
};

/// Cost-to-go field after a change in an area of the map, restricted to the cheapest paths from one start.
/// Costs and paths equal those of CostToGo::repair() and need less time. A* from the start
/// [hart_nilsson_raphael_1968], with the lower bound PatchBound, selects the cells; the cells on the cheapest
/// paths are then settled from the goal.
class PatchedField {
 public:
  /// `before` is the field before the change, with its edge layer already updated; it must outlive the
  /// object. `changed` is the box of the changed cells.
  PatchedField(const CostToGo& before, CellBox changed) : before_(before), changed_(changed) {}

  /// Result of settle(): settled, abandoned because of too many cells, or stopped.
  enum class Outcome { Settled, TooMuch, Stopped };

  /// Settles the cells of the cheapest path from the start, which is connected to the grid by `links`.
  /// Returns TooMuch if more than `most_cells` cells would have to be processed.
  Outcome settle(const std::vector<GridLink>& links, std::uint64_t most_cells, const StopCheck& stop = {});

  /// Returns the cost to the goal [J] from a cell of `links` on a cheapest path; empty for other cells.
  std::optional<double> cost_J(maps::Cell cell) const;

  /// Returns the cells of the cheapest path from a cell of `links` on this path to the goal.
  std::vector<maps::Cell> path(maps::Cell from) const;

 private:
  std::uint32_t distance(std::size_t index) const;

  const CostToGo& before_;
  CellBox changed_;
  std::unordered_map<std::uint32_t, std::uint32_t> distance_;  // cost in units, by padded index
};

}  // namespace talus::planner
