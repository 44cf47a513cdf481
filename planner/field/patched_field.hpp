#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_links.hpp>

namespace talus::planner {

/// The field of a goal after part of the map changed, for what lies on the best ways from one place only: the
/// same distances, and so the same path, as a CostToGo that was repaired, without its work. A* from the place
/// [hart_nilsson_raphael_1968], led by the field before the change (PatchBound), finds what must be seen;
/// then the cells on best ways are settled from the goal.
class PatchedField {
 public:
  /// The field is the one before the change, its edge layer already updated; it must outlive this object.
  PatchedField(const CostToGo& before, CellBox changed) : before_(before), changed_(changed) {}

  enum class Outcome { Settled, TooMuch, Stopped };

  /// Settles what is needed to leave a place by the best of its links; looks at no more than so many cells.
  Outcome settle(const std::vector<GridLink>& links, std::uint64_t most_cells, const StopCheck& stop = {});

  /// As of CostToGo, for the links on best ways; nothing for others.
  std::optional<double> cost_J(maps::Cell cell) const;

  /// As of CostToGo, from the link on the best way.
  std::vector<maps::Cell> path(maps::Cell from) const;

 private:
  std::uint32_t distance(std::size_t index) const;

  const CostToGo& before_;
  CellBox changed_;
  std::unordered_map<std::uint32_t, std::uint32_t> distance_;  // units, by padded index
};

}  // namespace talus::planner
