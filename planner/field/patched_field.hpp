#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_links.hpp>

namespace talus::planner {

/// Field of a goal after an area of the map changed, restricted to the cheapest paths from one place.
/// Distances and paths equal those of a repaired CostToGo, with less work. A* from the place
/// [hart_nilsson_raphael_1968], guided by the field before the change (PatchBound), selects the cells; the
/// cells on cheapest paths are then settled from the goal.
class PatchedField {
 public:
  /// `before` is the field before the change, with its edge layer already updated; `before` must outlive the
  /// object.
  PatchedField(const CostToGo& before, CellBox changed) : before_(before), changed_(changed) {}

  enum class Outcome { Settled, TooMuch, Stopped };

  /// Settles the cells needed to leave a place by its best link. Returns TooMuch if more than `most_cells`
  /// cells would be processed.
  Outcome settle(const std::vector<GridLink>& links, std::uint64_t most_cells, const StopCheck& stop = {});

  /// Returns CostToGo::cost_J() [J] for the cell of a link on a cheapest path; empty for other cells.
  std::optional<double> cost_J(maps::Cell cell) const;

  /// Returns CostToGo::path() from the cell of a link on the cheapest path.
  std::vector<maps::Cell> path(maps::Cell from) const;

 private:
  std::uint32_t distance(std::size_t index) const;

  const CostToGo& before_;
  CellBox changed_;
  std::unordered_map<std::uint32_t, std::uint32_t> distance_;  // units, by padded index
};

}  // namespace talus::planner
