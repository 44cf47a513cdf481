#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_links.hpp>

namespace talus::planner {

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
