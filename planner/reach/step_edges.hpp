#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Classifies the cells refused by Hazard::Step or Roughness from the heights around them: a sheer step,
/// which also tilts the fitted plane, or the edge of a slope, where the ground bends by more than the rover's
/// clearance. Ours.
///
/// A pair of neighbouring cells with the rise d between them and the rises a, b before and after has the step
/// |d - minmod(a, b)| (maps/terrain/step_height.hpp). The pair is an edge if its step exceeds the step of
/// every pair that the map does not refuse. An edge is Sheer if d exceeds a and b, in the direction of d, by
/// more than half of the step; otherwise the edge is of kind Slope if one of the three rises is a refused
/// gradient. A refused cell has the kind of the edge with the fewest king's moves over refused cells.
class StepEdges {
 public:
  enum class Kind : std::uint8_t { None, Sheer, Slope };

  /// Returns true if the ground of a cell refuses a gradient >= 0 [-], straight up or down.
  using Refuses = std::function<bool(maps::Cell cell, double gradient)>;

  /// Classifies all cells; on a map without heights all cells are None.
  StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses);

  Kind at(maps::Cell cell) const noexcept { return kinds_[map_.grid().index(cell)]; }

  /// Returns the code of a cell with the gradient of the ground without sheer steps: medians of the rises
  /// between neighbouring cells in the surrounding 5 x 5 cells.
  costmap::CellCode settled(maps::Cell cell) const;

 private:
  // A pair of neighbouring cells in a row or column, and the rises [m] before, between and after them.
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
