#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/planner/bound/mesh_costs.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kHeadingCount = DirectionalCostBounds::kHeadings;
constexpr std::size_t kQuarter = kHeadingCount / 4;
constexpr std::size_t kEighth = kHeadingCount / 8;

// For each heading within one angle of a triangle: distance to the opposite side [cell sides], and the
// position on that side where the heading meets the side [0, 1].
template <std::size_t kCount>
struct Fan {
  std::array<float, kCount> share, length;
};

constexpr double kTurn = 2.0 * std::numbers::pi / kHeadingCount;

// Headings out of a corner, from the cell's side towards the centre.
const Fan<kEighth + 1>& cornerFan() noexcept {
  static const auto fan = [] {
    Fan<kEighth + 1> made;
    for (std::size_t i = 0; i <= kEighth; ++i) {
      const double angle = static_cast<double>(i) * kTurn, sum = std::cos(angle) + std::sin(angle);
      made.share[i] = static_cast<float>(2.0 * std::sin(angle) / sum);
      made.length[i] = static_cast<float>(1.0 / sum);
    }
    made.share[kEighth] = 1.0F;
    return made;
  }();
  return fan;
}

// Headings out of the centre, from the first corner of a triangle to the second.
const Fan<kQuarter + 1>& middleFan() noexcept {
  static const auto fan = [] {
    Fan<kQuarter + 1> made;
    for (std::size_t i = 0; i <= kQuarter; ++i) {
      const double angle = (static_cast<double>(i) - static_cast<double>(kEighth)) * kTurn;
      made.share[i] = static_cast<float>(0.5 + 0.5 * std::tan(angle));
      made.length[i] = static_cast<float>(0.5 / std::cos(angle));
    }
    made.share[0] = 0.0F;
    made.share[kQuarter] = 1.0F;
    return made;
  }();
  return fan;
}

// Returns the offset of heading indices: 0 for motions from the node, half a turn for motions to the node.
constexpr std::size_t turnOf(TriangleCosts::Way way) noexcept {
  return way == TriangleCosts::Way::FromNode ? 0 : kHeadingCount / 2;
}

constexpr std::size_t headingOf(std::size_t triangle, std::size_t k) noexcept {
  return (kQuarter * triangle + k) % kHeadingCount;
}

// Headings as columns.
struct Headings {
  std::array<float, kHeadingCount> x, y;
};

const Headings& headingColumns() noexcept {
  static const auto made = [] {
    Headings all;
    for (std::size_t k = 0; k < kHeadingCount; ++k) {
      all.x[k] = static_cast<float>(DirectionalCostBounds::heading(static_cast<int>(k)).x);
      all.y[k] = static_cast<float>(DirectionalCostBounds::heading(static_cast<int>(k)).y);
    }
    return all;
  }();
  return made;
}

constexpr std::uint32_t kClosed = 0xfffffffeU;  // slot of a cell without an allowed heading
constexpr int kRecentBits = 14;

std::size_t indexIn(const maps::Grid& grid, maps::Cell cell) noexcept {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.width) +
         static_cast<std::size_t>(cell.column);
}

}  // namespace

TriangleCosts::TriangleCosts(const DirectionalCostBounds::Limits& limits, double side_m) noexcept {
  for (std::size_t k = 0; k < kStored; ++k)
    prices[k] = static_cast<float>(side_m) * limits[k % kHeadingCount];
}

float TriangleCosts::first(std::size_t triangle, const Values& values, Way way) const noexcept {
  const auto& fan = cornerFan();
  const float* price = prices.data() + headingOf(triangle, turnOf(way));
  const float rise = values.middle - values.second;
  Lanes least;
  for (std::size_t i = 0; i < kEighth; ++i)
    least[i] = values.second + fan.share[i] * rise + price[i] * fan.length[i];
  return less(leastOf(least), values.middle + price[kEighth] * fan.length[kEighth]);
}

float TriangleCosts::second(std::size_t triangle, const Values& values, Way way) const noexcept {
  const auto& fan = cornerFan();
  const float* price = prices.data() + headingOf(triangle, 3 * kEighth + turnOf(way));
  const float rise = values.middle - values.first;
  Lanes least;
  for (std::size_t i = 0; i < kEighth; ++i)
    least[i] = values.first + fan.share[i] * rise + price[kEighth - i] * fan.length[i];
  return less(leastOf(least), values.middle + price[0] * fan.length[kEighth]);
}

float TriangleCosts::middle(std::size_t triangle, const Values& values, Way way) const noexcept {
  const auto& fan = middleFan();
  const float* price = prices.data() + headingOf(triangle, 5 * kEighth + turnOf(way));
  const float rise = values.second - values.first;
  Lanes least;
  for (std::size_t i = 0; i < kEighth; ++i) {
    const std::size_t j = i + kEighth;
    least[i] = less(values.first + fan.share[i] * rise + price[i] * fan.length[i],
                    values.first + fan.share[j] * rise + price[j] * fan.length[j]);
  }
  return less(leastOf(least), values.second + price[kQuarter] * fan.length[kQuarter]);
}

std::optional<TriangleCosts::Rise> TriangleCosts::lowered(std::size_t triangle, std::size_t node,
                                                          const Values& values, float wanted,
                                                          float slack) const noexcept {
  const auto look = [&](const auto& fan, std::size_t begin, bool back, Rise now) -> std::optional<Rise> {
    const std::size_t last = fan.share.size() - 1;
    const float* price = prices.data() + headingOf(triangle, begin + turnOf(Way::ToNode));
    const auto limit = [&](std::size_t i) { return price[back ? last - i : i] * fan.length[i]; };
    bool over = false;
    for (std::size_t i = 0; i <= last; ++i)
      over = over || now.a + fan.share[i] * (now.b - now.a) > limit(i) * (1.0F + slack);
    if (!over) return std::nullopt;
    float least = now.a, most = now.a;
    for (std::size_t i = 0; i < last; ++i) {
      const float rest = 1.0F - fan.share[i];
      least = less(least, (limit(i) - fan.share[i] * now.b) / rest);
      if (now.b >= 0.0F) most = less(most, limit(i) / rest);
    }
    Rise to{now.b < 0.0F ? least : std::clamp(wanted, least, std::max(least, most)), now.b};
    for (std::size_t i = 1; i <= last; ++i)
      to.b = less(to.b, (limit(i) - (1.0F - fan.share[i]) * to.a) / fan.share[i]);
    return to;
  };
  if (node == 0)
    return look(cornerFan(), 0, false, {values.second - values.first, values.middle - values.first});
  if (node == 1)
    return look(cornerFan(), 3 * kEighth, true,
                {values.first - values.second, values.middle - values.second});
  return look(middleFan(), 5 * kEighth, false, {values.first - values.middle, values.second - values.middle});
}

costmap::Direction TriangleCosts::fall(std::size_t triangle, const Values& values) noexcept {
  const double along = static_cast<double>(values.first) - static_cast<double>(values.second);
  const double up = 2.0 * (static_cast<double>(values.first) - static_cast<double>(values.middle)) - along;
  switch (triangle) {
    case 0:
      return {along, up};
    case 1:
      return {-up, along};
    case 2:
      return {-along, -up};
    default:
      return {up, -along};
  }
}

bool TriangleCosts::exceeds(const costmap::Direction& fall, float share) const noexcept {
  const Headings& h = headingColumns();
  const auto x = static_cast<float>(fall.x), y = static_cast<float>(fall.y);
  std::array<float, 8> most;
  most.fill(-1.0F);
  for (std::size_t k = 0; k < kHeadingCount; k += 8)
    for (std::size_t i = 0; i < 8; ++i) {
      const float over = x * h.x[k + i] + y * h.y[k + i] - share * prices[k + i];
      most[i] = most[i] > over ? most[i] : over;
    }
  return *std::ranges::max_element(most) > 0.0F;
}

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
