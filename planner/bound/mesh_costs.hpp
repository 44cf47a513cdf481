#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/bound/cell_mesh.hpp>
#include <talus/planner/bound/directional_cost_bounds.hpp>
#include <talus/planner/bound/triangle_costs.hpp>

namespace talus::planner {

/// Heading costs of the map's cells, computed on first request. Each cell with an allowed heading has a slot
/// index, by which other data of the cell are stored, too. Not thread-safe.
class MeshCosts {
 public:
  explicit MeshCosts(std::shared_ptr<const costmap::CostGrid> map);

  static constexpr std::uint32_t kNone = 0xffffffffU;

  const CellMesh& mesh() const noexcept { return mesh_; }
  /// Slot of a cell; kNone outside the map and for cells without an allowed heading.
  std::uint32_t slotOf(maps::Cell cell);
  /// Slot of a cell if slotOf() was called for the cell before; otherwise kNone.
  std::uint32_t knownSlotOf(maps::Cell cell) const noexcept;
  const TriangleCosts& of(std::uint32_t slot) const noexcept { return prices_[slots_[slot].prices]; }
  maps::Cell cellOf(std::uint32_t slot) const noexcept { return slots_[slot].cell; }
  std::size_t slots() const noexcept { return slots_.size(); }

 private:
  struct Slot {
    std::uint32_t prices;
    maps::Cell cell;
  };
  // Most recent code of a hash value and its costs. Neighbouring cells often have the same code.
  struct Recent {
    std::uint32_t bits = 0, prices = kNone;
  };

  std::uint32_t newPrices(costmap::CellCode code);

  std::shared_ptr<const costmap::CostGrid> map_;
  CellMesh mesh_;
  DirectionalCostBounds limits_;
  std::vector<std::uint32_t> slot_of_;  // by cell
  std::vector<Slot> slots_;
  std::vector<TriangleCosts> prices_;
  std::vector<Recent> recent_;  // by hash
};

}  // namespace talus::planner
