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

/// Costs of all steps from a cell centre to its eight neighbours, on one version of the map, in units of
/// EdgeUnits; 16 bytes per cell. A step consists of two half steps, one in the cell that it leaves and one in
/// the cell that it enters, both on the heading of the step. Its cost is that of MotionCost for the segment
/// between the centres. A diagonal step is blocked unless the two other cells at its corner also allow the
/// heading.
class EdgeLayer {
 public:
  static constexpr std::uint16_t kBlocked = EdgeUnits::kBlocked;

  /// Computes the layer with `threads` threads; the result does not depend on their number. The computation
  /// ends early when a stop is requested; complete() is then false.
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads = 1,
            const StopCheck& stop = {}, Kernels kernels = Kernels::Best);

  /// Size of a grid of points other than the cells of the map, for a layer without step costs.
  struct Unfilled {
    int width;
    int height;
  };
  /// Creates a layer without step costs, which the caller writes through into().
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, Unfilled points);

  std::uint16_t* into(std::size_t index) noexcept { return edges_.get() + 8 * index; }

  /// Returns the costs of the eight steps into the cell with a padded index. The index of a step is the
  /// heading, seen from the cell, of the neighbour at which the step begins.
  const std::uint16_t* into(std::size_t index) const noexcept { return edges_.get() + 8 * index; }

  const PaddedGrid& padded() const noexcept { return padded_; }
  const EdgeUnits& units() const noexcept { return units_; }
  const costmap::CostGrid& map() const noexcept { return *map_; }
  const std::shared_ptr<const costmap::CostGrid>& mapPointer() const noexcept { return map_; }
  /// Returns false if a stop ended the computation.
  bool complete() const noexcept { return complete_; }

  /// Updates the layer to the newer version `newer` of the same grid. The units must extend the present units
  /// (EdgeUnits::extends()), and cells outside the box `changed` must be equal in both versions.
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
