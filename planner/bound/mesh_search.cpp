#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/planner/bound/mesh_search.hpp>
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

MeshCosts::MeshCosts(std::shared_ptr<const costmap::CostGrid> map, DirectionalCostBounds& limits)
    : map_(std::move(map)), mesh_(map_->grid()), limits_(limits), slot_of_(map_->grid().size(), kNone) {}

std::uint32_t MeshCosts::newPrices(costmap::CellCode code) {
  const auto [known, added] = prices_of_.try_emplace(code.number(), kClosed);
  DirectionalCostBounds::Limits limits;
  if (!added || !limits_.of(code, limits)) return known->second;
  known->second = static_cast<std::uint32_t>(prices_.size());
  prices_.emplace_back(limits, mesh_.grid().resolution_m);
  return known->second;
}

std::uint32_t MeshCosts::slotOf(maps::Cell cell) {
  if (!mesh_.grid().contains(cell)) return kNone;
  std::uint32_t& slot = slot_of_[mesh_.grid().index(cell)];
  if (slot == kNone) {
    const std::uint32_t prices = newPrices(map_->at(cell));
    slot = prices == kClosed ? kClosed : static_cast<std::uint32_t>(slots_.size());
    if (slot != kClosed) slots_.push_back({prices, cell});
  }
  return slot == kClosed ? kNone : slot;
}

std::uint32_t MeshCosts::knownSlotOf(maps::Cell cell) const noexcept {
  if (!mesh_.grid().contains(cell)) return kNone;
  const std::uint32_t slot = slot_of_[mesh_.grid().index(cell)];
  return slot == kClosed ? kNone : slot;
}

namespace {

// 2^kUnits queue units = cost of half a cell side at the lowest cost per metre.
constexpr unsigned kUnits = 4;
constexpr std::uint64_t kReach = std::uint64_t{1} << 20;  // largest spread of queued keys [units]
// Indices of a triangle's nodes: two corners, then the cell's centre.
constexpr std::size_t kFirst = 0, kSecond = 1, kThird = 2;

}  // namespace

MeshSearch::MeshSearch(MeshCosts& prices, const Options& options)
    : prices_(prices),
      options_(options),
      values_(prices.mesh().nodes(), kFar),
      expanded_(prices.mesh().nodes(), kFar),
      queue_(kUnits, kReach),
      unit_J_(0.5 * options.cheapest_J * prices.mesh().grid().resolution_m / (1U << kUnits)) {}

float MeshSearch::restIn(maps::Cell cell) const noexcept {
  if (options_.rest == nullptr || !prices_.mesh().grid().contains(cell)) return kFar;
  const CellMesh::Nodes nodes = prices_.mesh().nodesOf(cell);
  const std::vector<float>& corners = *options_.rest;
  return std::min({corners[nodes[0]], corners[nodes[1]], corners[nodes[2]], corners[nodes[3]]});
}

double MeshSearch::rest(std::uint32_t node) const noexcept {
  if (options_.rest == nullptr) return 0.0;
  const maps::Cell at = prices_.mesh().positionOf(node);
  if (node >= prices_.mesh().corners()) return static_cast<double>(restIn(at));
  return static_cast<double>(
      std::min({restIn(at), restIn({at.column - 1, at.row}), restIn({at.column, at.row - 1}),
                restIn({at.column - 1, at.row - 1})}));
}

bool MeshSearch::lower(std::uint32_t node, float value) {
  if (!(value < values_[node] - 1e-3F * static_cast<float>(unit_J_))) return false;
  values_[node] = value;
  const double units = (static_cast<double>(value) - base_J_) / unit_J_;
  const auto key = static_cast<std::uint64_t>(std::max(units, 0.0));
  lowest_ = std::min(lowest_, key);
  queue_.push(key, node);
  return true;
}

bool MeshSearch::run(std::uint64_t end, std::size_t quota, const StopCheck& stop) {
  bool stopped = false;
  queue_.startAt(lowest_);
  queue_.run(
      [&](std::uint32_t node) {
        if (!(values_[node] < expanded_[node])) return;
        if (static_cast<double>(values_[node]) + rest(node) > options_.most_J) {
          changeAround(node);
          return;
        }
        if ((++taken_ & 4095U) == 0 && stop()) stopped = true;
        expanded_[node] = values_[node];
        expand(node);
      },
      [&](std::uint64_t key) {
        lowest_ = key;
        front_ = std::max(front_, std::min(key, end));
        return !stopped && key < end && taken_ < quota;
      });
  if (queue_.queued() == 0) lowest_ = kEnd;
  return !stopped;
}

void MeshSearch::expand(std::uint32_t node) {
  const CellMesh& mesh = prices_.mesh();
  const maps::Cell at = mesh.positionOf(node);
  if (node >= mesh.corners()) {
    fromMiddle(at);
    return;
  }
  fromCorner({at.column, at.row}, 0);
  fromCorner({at.column - 1, at.row}, 1);
  fromCorner({at.column - 1, at.row - 1}, 2);
  fromCorner({at.column, at.row - 1}, 3);
}

void MeshSearch::fromCorner(maps::Cell cell, std::size_t corner) {
  const std::uint32_t slot = prices_.slotOf(cell);
  if (slot == MeshCosts::kNone) return;
  change(slot);
  const TriangleCosts& prices = prices_.of(slot);
  const CellMesh::Nodes nodes = prices_.mesh().nodesOf(cell);
  const std::size_t after = CellMesh::next(corner), before = (corner + 3) % 4;
  const float middle = values_[nodes[CellMesh::kMiddle]], own = values_[nodes[corner]];
  const TriangleCosts::Values left{own, values_[nodes[after]], middle},
      right{values_[nodes[before]], own, middle};
  float second = prices.second(corner, left, options_.way), first = prices.first(before, right, options_.way),
        third =
            std::min(prices.middle(corner, left, options_.way), prices.middle(before, right, options_.way));
  if (const Cell& of = cells_[slot]; of.capped) {
    second = std::min(second, own + of.caps[corner][capOf(kSecond, kFirst)]);
    first = std::min(first, own + of.caps[before][capOf(kFirst, kSecond)]);
    third = std::min(third, own + std::min(of.caps[corner][capOf(kThird, kFirst)],
                                           of.caps[before][capOf(kThird, kSecond)]));
  }
  lower(nodes[after], second);
  lower(nodes[before], first);
  lower(nodes[CellMesh::kMiddle], third);
}

void MeshSearch::fromMiddle(maps::Cell cell) {
  const std::uint32_t slot = prices_.slotOf(cell);
  if (slot == MeshCosts::kNone) return;
  change(slot);
  const TriangleCosts& prices = prices_.of(slot);
  const CellMesh::Nodes nodes = prices_.mesh().nodesOf(cell);
  const float middle = values_[nodes[CellMesh::kMiddle]];
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t first = nodes[k], second = nodes[CellMesh::next(k)];
    const TriangleCosts::Values values{values_[first], values_[second], middle};
    const Caps& caps = cells_[slot].caps[k];
    lower(first, std::min(prices.first(k, values, options_.way), middle + caps[capOf(kFirst, kThird)]));
    lower(second, std::min(prices.second(k, values, options_.way), middle + caps[capOf(kSecond, kThird)]));
  }
}

void MeshSearch::cap(std::uint32_t slot, std::size_t triangle, std::size_t above,
                     const TriangleCosts::Rise& rise) {
  Cell& of = cells_[slot];
  of.capped = true;
  const std::size_t a = above == kFirst ? kSecond : kFirst, b = above == kThird ? kSecond : kThird;
  for (const auto& [node, most] : {std::pair{a, rise.a}, std::pair{b, rise.b}}) {
    float& known = of.caps[triangle][capOf(node, above)];
    known = std::min(known, std::max(most, 0.0F));
  }
}

bool MeshSearch::relax(std::uint32_t slot, std::size_t triangle) {
  change(slot);
  const CellMesh::Nodes all = prices_.mesh().nodesOf(prices_.cellOf(slot));
  const std::array<std::uint32_t, 3> nodes{all[triangle], all[CellMesh::next(triangle)],
                                           all[CellMesh::kMiddle]};
  const TriangleCosts& prices = prices_.of(slot);
  const Caps& caps = cells_[slot].caps[triangle];
  const TriangleCosts::Values v{values_[nodes[kFirst]], values_[nodes[kSecond]], values_[nodes[kThird]]};
  const bool first = lower(nodes[kFirst], std::min({prices.first(triangle, v, options_.way),
                                                    v.second + caps[capOf(kFirst, kSecond)],
                                                    v.middle + caps[capOf(kFirst, kThird)]}));
  const bool second = lower(nodes[kSecond], std::min({prices.second(triangle, v, options_.way),
                                                      v.first + caps[capOf(kSecond, kFirst)],
                                                      v.middle + caps[capOf(kSecond, kThird)]}));
  const bool third = lower(nodes[kThird], std::min({prices.middle(triangle, v, options_.way),
                                                    v.first + caps[capOf(kThird, kFirst)],
                                                    v.second + caps[capOf(kThird, kSecond)]}));
  return first || second || third;
}

void MeshSearch::change(std::uint32_t slot) {
  if (slot >= cells_.size()) cells_.resize(prices_.slots());
  if (cells_[slot].changed) return;
  cells_[slot].changed = true;
  changed_.push_back(slot);
}

// Marks the cells around a node that already have a slot.
void MeshSearch::changeAround(std::uint32_t node) {
  const maps::Cell at = prices_.mesh().positionOf(node);
  const bool corner = node < prices_.mesh().corners();
  for (const int row : {at.row, at.row - 1})
    for (const int column : {at.column, at.column - 1}) {
      if (!corner && !(row == at.row && column == at.column)) continue;
      if (const std::uint32_t slot = prices_.knownSlotOf({column, row}); slot != MeshCosts::kNone)
        change(slot);
    }
}

std::vector<std::uint32_t> MeshSearch::takeChanged() {
  for (const std::uint32_t slot : changed_) cells_[slot].changed = false;
  return std::exchange(changed_, {});
}

}  // namespace talus::planner
