#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/field/padded_grid.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/large_array.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Cost of every step of the 8-neighbourhood on one version of the map, in units of EdgeUnits; 16 bytes per
/// cell. A step consists of two half steps, in the cell left and in the cell entered, both in the heading of
/// the step: the MotionCost of the segment between the centres. A diagonal step is blocked unless both cells
/// beside the step also allow the heading.
class EdgeLayer {
 public:
  static constexpr std::uint16_t kBlocked = EdgeUnits::kBlocked;

  /// Builds the layer with `threads` threads; the result does not depend on their number. Ends early and
  /// incomplete when a stop is requested; see complete().
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads = 1,
            const StopCheck& stop = {}, Kernels kernels = Kernels::Best);

  /// Creates a layer for a grid of points other than the map's cells. The caller fills the steps through
  /// into().
  struct Unfilled {
    int width;
    int height;
  };
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, Unfilled points);

  std::uint16_t* into(std::size_t index) noexcept { return edges_.get() + 8 * index; }

  /// The eight steps into the cell at a padded index, indexed by the heading in which the neighbour lies.
  const std::uint16_t* into(std::size_t index) const noexcept { return edges_.get() + 8 * index; }

  const PaddedGrid& padded() const noexcept { return padded_; }
  const EdgeUnits& units() const noexcept { return units_; }
  const costmap::CostGrid& map() const noexcept { return *map_; }
  const std::shared_ptr<const costmap::CostGrid>& mapPointer() const noexcept { return map_; }
  bool complete() const noexcept { return complete_; }

  /// Updates the layer to a newer version of the same grid. The new units must extend the present units, and
  /// cells outside the box must be unchanged.
  void update(std::shared_ptr<const costmap::CostGrid> newer, const EdgeUnits& units, CellBox changed);

 private:
  void buildRows(CellBox box);
  void blockBorder();

  std::shared_ptr<const costmap::CostGrid> map_;
  EdgeUnits units_;
  PaddedGrid padded_;
  LargeArray<std::uint16_t> edges_;
  bool vectors_ = false;
  bool complete_ = false;
};

}  // namespace talus::planner
