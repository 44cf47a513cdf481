#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/directional_cost_bounds.hpp>
#include <talus/planner/bound/triangle_costs.hpp>

namespace talus::planner {

/// Costs by heading of the cells of a map (TriangleCosts), computed at the first request. Each cell that
/// allows some heading has a slot number; other data of the cell are also stored by this number. Not
/// thread-safe.
class MeshCosts {
 public:
  /// `limits` are those of the map's cost function. Cells outside `region`, by index of the cell, are closed; empty:
  /// none. Both must outlive the object.
  MeshCosts(std::shared_ptr<const costmap::CostGrid> map, DirectionalCostBounds& limits,
            const std::vector<bool>& region);

  /// Slot number of a cell without a slot.
  static constexpr std::uint32_t kNone = 0xffffffffU;

  const CellMesh& mesh() const noexcept { return mesh_; }
  /// Returns the slot of a cell, which is created if necessary; kNone outside the map and the region
  /// and for cells that allow no heading.
  std::uint32_t slotOf(maps::Cell cell);
  /// Returns the slot of a cell if slotOf() was called for the cell before; otherwise kNone.
  std::uint32_t knownSlotOf(maps::Cell cell) const noexcept;
  /// Returns the costs of the cell with a slot.
  const TriangleCosts& of(std::uint32_t slot) const noexcept { return prices_[slots_[slot].prices]; }
  /// Returns the cell with a slot.
  maps::Cell cellOf(std::uint32_t slot) const noexcept { return slots_[slot].cell; }
  /// Returns the number of slots.
  std::size_t slots() const noexcept { return slots_.size(); }

 private:
  struct Slot {
    std::uint32_t prices;
    maps::Cell cell;
  };
  // Most recent cell code with a given hash value, and its costs. Neighbouring cells often have equal codes.
  struct Recent {
    std::uint64_t code = 0;
    std::uint32_t prices = kNone;
  };

  std::uint32_t newPrices(costmap::CellCode code);

  std::shared_ptr<const costmap::CostGrid> map_;
  CellMesh mesh_;
  DirectionalCostBounds& limits_;
  const std::vector<bool>& region_;
  std::vector<std::uint32_t> slot_of_;  // slot by cell index
  std::vector<Slot> slots_;
  std::vector<TriangleCosts> prices_;
  std::vector<Recent> recent_;  // by hash value of the cell code
};

}  // namespace talus::planner
