#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Classification of the cells that Hazard::Step or Hazard::Roughness excludes, from the heights around them.
/// A cell is either at a sheer step, which also tilts the plane fitted to the ground, or at the edge of a
/// slope, where the change of slope exceeds the ground clearance of the rover. Ours.
///
/// For two neighbouring cells, d is the rise between them, a the rise before the first cell and b the rise
/// after the second cell. The step of the pair is |d - minmod(a, b)| (maps/terrain/step_height.hpp). The pair
/// is an edge if its step exceeds the step of every pair without an excluded cell. An edge is Sheer if d
/// exceeds a and b, in the direction of d, by more than half of the step. Otherwise the edge is of kind Slope
/// if one of the three rises is a gradient that the ground does not allow. An excluded cell has the kind of
/// the edge that is nearest in king's moves over excluded cells.
class StepEdges {
 public:
  enum class Kind : std::uint8_t { None, Sheer, Slope };

  /// Function that returns true if the rover may not drive straight up or straight down a gradient >= 0 [-]
  /// on the ground of a cell.
  using Refuses = std::function<bool(maps::Cell cell, double gradient)>;

  /// Classifies all cells. On a map without heights all cells have the kind None.
  StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses);

  /// Returns the kind of a cell.
  Kind at(maps::Cell cell) const noexcept { return kinds_[map_.grid().index(cell)]; }

  /// Returns the code of a cell with the gradient of the ground without sheer steps: medians of the rises
  /// between neighbouring cells in the surrounding 5 x 5 cells.
  costmap::CellCode settled(maps::Cell cell) const;

 private:
  // Two neighbouring cells in a row or column, and the rises [m] before, between and after both cells.
  struct Pair {
    maps::Cell first, second;
    double before, between, after;

    double step_m() const noexcept;
    double excess_m() const noexcept;
  };

  double height_m(maps::Cell cell) const noexcept;
  std::optional<Pair> pair(maps::Cell cell, maps::Cell step) const noexcept;
  template <typename Take>
  void forEachPair(Take take) const;
  double highestAllowed_m(const HazardsOf& hazards) const;
  void spread(const HazardsOf& hazards, const std::vector<maps::Cell>& sheer,
              const std::vector<maps::Cell>& of_slopes);

  const costmap::CostGrid& map_;
  std::vector<Kind> kinds_;
};

}  // namespace talus::planner
