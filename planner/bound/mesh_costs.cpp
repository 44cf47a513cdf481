#include <utility>

#include <talus/planner/bound/mesh_costs.hpp>

namespace talus::planner {
namespace {

constexpr std::uint32_t kClosed = 0xfffffffeU;  // slot of a cell without an allowed heading
constexpr int kRecentBits = 14;

std::size_t indexIn(const maps::Grid& grid, maps::Cell cell) noexcept {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.width) +
         static_cast<std::size_t>(cell.column);
}

}  // namespace

MeshCosts::MeshCosts(std::shared_ptr<const costmap::CostGrid> map, DirectionalCostBounds& limits,
                     const std::vector<bool>& region)
    : map_(std::move(map)),
      mesh_(map_->grid()),
      limits_(limits),
      region_(region),
      slot_of_(map_->grid().size(), kNone),
      recent_(std::size_t{1} << kRecentBits) {}

std::uint32_t MeshCosts::newPrices(costmap::CellCode code) {
  Recent& recent = recent_[code.recentSlot(kRecentBits)];
  if (recent.code == code.number() && recent.prices != kNone) return recent.prices;
  recent = {code.number(), kClosed};
  DirectionalCostBounds::Limits limits;
  if (!limits_.of(code, limits)) return kClosed;
  recent.prices = static_cast<std::uint32_t>(prices_.size());
  prices_.emplace_back(limits, mesh_.grid().resolution_m);
  return recent.prices;
}

std::uint32_t MeshCosts::slotOf(maps::Cell cell) {
  if (!mesh_.grid().contains(cell) || (!region_.empty() && !region_[indexIn(mesh_.grid(), cell)]))
    return kNone;
  std::uint32_t& slot = slot_of_[indexIn(mesh_.grid(), cell)];
  if (slot == kNone) {
    const std::uint32_t prices = newPrices(map_->at(cell));
    slot = prices == kClosed ? kClosed : static_cast<std::uint32_t>(slots_.size());
    if (slot != kClosed) slots_.push_back({prices, cell});
  }
  return slot == kClosed ? kNone : slot;
}

std::uint32_t MeshCosts::knownSlotOf(maps::Cell cell) const noexcept {
  if (!mesh_.grid().contains(cell) || (!region_.empty() && !region_[indexIn(mesh_.grid(), cell)]))
    return kNone;
  const std::uint32_t slot = slot_of_[indexIn(mesh_.grid(), cell)];
  return slot == kClosed ? kNone : slot;
}

}  // namespace talus::planner
