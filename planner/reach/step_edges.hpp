#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Separates the cells that Hazard::Step or Roughness refuses by what the heights around them are: a sheer step, which also
/// tilts the plane fitted over it, or the edge of a slope, where the ground bends by more than the rover clears. Ours.
///
/// A pair of neighbouring cells with the rise d between them and the rises a, b before and after has the step
/// |d - minmod(a, b)| (maps/terrain/step_height.hpp). It is an edge where this exceeds the step of every pair that the
/// map does not refuse. An edge is Sheer where d exceeds a and b, in its own direction, by more than half of the step;
/// else it is of a Slope where one of the three is a refused gradient. A refused cell is of the kind of its nearest
/// edge, counted over refused cells.
class StepEdges {
 public:
  enum class Kind : std::uint8_t { None, Sheer, Slope };

  /// Whether the ground of a cell refuses a gradient >= 0 [-], straight up or down.
  using Refuses = std::function<bool(maps::Cell cell, double gradient)>;

  /// All cells are None on a map without heights.
  StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses);

  Kind at(maps::Cell cell) const noexcept { return kinds_[map_.grid().index(cell)]; }

  /// The code of a cell with the gradient of the ground without sheer steps: medians of the rises between neighbouring
  /// cells of the 5 x 5 around it.
  costmap::CellCode settled(maps::Cell cell) const;

 private:
  // A pair of neighbouring cells of a row or column, and the rises [m] before, between and after them.
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
