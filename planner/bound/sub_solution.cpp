#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/planner/bound/sub_solution.hpp>
#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {
namespace {

constexpr std::uint32_t kClosed = 0xfffffffeU;  // slot of a cell that no heading may enter
constexpr std::size_t kCodes = std::size_t{1} << 14;
constexpr std::uint64_t kEnd = ~std::uint64_t{0};
constexpr std::size_t kBand = 256;  // nodes of the search between two looks at what exceeds its limits
constexpr int kMostRounds = 60;     // of lowering prices behind the front; more are for the check to see
constexpr float kSlack = 5e-4F;     // that a triangle may exceed its limits by
constexpr double kWithin = 1.02;    // of the cost known: the nodes that are searched lie within it
constexpr unsigned kUnits = 4;      // of the queue: 2^kUnits to half a side at the cheapest metre
constexpr std::uint64_t kReach = std::uint64_t{1} << 20;  // units that queued values lie apart

}  // namespace

SubSolution::SubSolution(const Parts& parts, const StopCheck& stop)
    : parts_(parts),
      mesh_(parts.map->grid()),
      stop_(stop),
      limits_(parts.map->cost()),
      values_(mesh_.nodes(), kFar),
      expanded_(mesh_.nodes(), kFar),
      slot_of_(parts.map->grid().size(), kNone),
      recent_(kCodes),
      queue_(kUnits, kReach),
      unit_J_(0.5 * parts.cheapest_J * mesh_.grid().resolution_m / (1U << kUnits)),
      most_J_(kWithin * parts.known_J + parts.cheapest_J * mesh_.grid().resolution_m) {
  parts_.goal_tolerance_m > 0.0 ? seedDisc() : seedPlane();
  while (queue_.queued() > 0)
    if (!search(kEnd, taken_ + kBand) || !settle(front_)) return;
  complete_ = settle(kEnd);
}

std::uint32_t SubSolution::newPrices(costmap::CellCode code) {
  Recent& recent = recent_[(code.bits() * 2654435761U) >> 18];  // multiplicative hashing, kCodes values
  if (recent.bits == code.bits() && recent.prices != kNone) return recent.prices;
  recent = {code.bits(), kClosed};
  HeadingLimits::Limits limits;
  if (!limits_.of(code, limits)) return kClosed;
  recent.prices = static_cast<std::uint32_t>(prices_.size());
  prices_.emplace_back(limits, mesh_.grid().resolution_m);
  return recent.prices;
}

SubSolution::Slot* SubSolution::slotOf(maps::Cell cell) {
  if (!mesh_.grid().contains(cell)) return nullptr;
  std::uint32_t& slot = slot_of_[indexOf(cell)];
  if (slot == kNone) {
    const std::uint32_t prices = newPrices(parts_.map->at(cell));
    slot = prices == kClosed ? kClosed : static_cast<std::uint32_t>(slots_.size());
    if (slot != kClosed) slots_.push_back({.prices = prices, .cell = cell});
  }
  return slot == kClosed ? nullptr : &slots_[slot];
}

const TrianglePrices* SubSolution::pricesOf(maps::Cell cell) const noexcept {
  const std::uint32_t slot = slot_of_[indexOf(cell)];
  return slot < kClosed ? &prices_[slots_[slot].prices] : nullptr;
}

double SubSolution::restFrom(std::uint32_t node) const {
  return parts_.cheapest_J * distance_m(mesh_.placeOf(node), parts_.places.from);
}

void SubSolution::lower(std::uint32_t node, float value) {
  if (!(value < values_[node] - 1e-3F * static_cast<float>(unit_J_))) return;
  values_[node] = value;
  const double units = (static_cast<double>(value) - base_J_) / unit_J_;
  const auto key = static_cast<std::uint64_t>(std::max(units, 0.0));
  lowest_ = std::min(lowest_, key);
  queue_.push(key, node);
}

// A route may end anywhere in the disc.
void SubSolution::seedDisc() {
  for (const maps::Cell cell : cellsWithin(mesh_.grid(), parts_.places.to, parts_.goal_tolerance_m))
    if (slotOf(cell) != nullptr)
      for (const std::uint32_t node : mesh_.nodesOf(cell)) lower(node, 0.0F);
}

// A plane in the goal's cell, 0 at the goal, that falls along the straight line from the start as the limits allow.
void SubSolution::seedPlane() {
  const maps::Point goal = parts_.places.to;
  const auto cell = mesh_.grid().cellAt(goal);
  const Slot* slot = cell ? slotOf(*cell) : nullptr;
  if (slot == nullptr) return;
  constexpr double sector = 2.0 * std::numbers::pi / HeadingLimits::kHeadings;
  const double angle = std::atan2(goal.y_m - parts_.places.from.y_m, goal.x_m - parts_.places.from.x_m) +
                       2.0 * std::numbers::pi;
  const int k = static_cast<int>(angle / sector) % HeadingLimits::kHeadings;
  const costmap::Direction a = HeadingLimits::heading(k), b = HeadingLimits::heading(k + 1);
  const auto& prices = prices_[slot->prices].prices;
  const auto at_a = static_cast<double>(prices[static_cast<std::size_t>(k)]),
             at_b = static_cast<double>(prices[static_cast<std::size_t>(k) + 1]);
  const double scale = 1.0 / (std::sin(sector) * mesh_.grid().resolution_m);
  const double fall_x = (at_a * b.y - at_b * a.y) * scale, fall_y = (at_b * a.x - at_a * b.x) * scale;
  base_J_ = -2.0 * std::hypot(fall_x, fall_y) * mesh_.grid().resolution_m;
  for (const std::uint32_t node : mesh_.nodesOf(*cell)) {
    const maps::Point place = mesh_.placeOf(node);
    lower(node, static_cast<float>(fall_x * (goal.x_m - place.x_m) + fall_y * (goal.y_m - place.y_m)));
  }
}

// Up to a key, or until so many nodes are taken in all; false when stopped.
bool SubSolution::search(std::uint64_t end, std::size_t quota) {
  bool stopped = false;
  queue_.startAt(lowest_);
  queue_.run(
      [&](std::uint32_t node) {
        if (!(values_[node] < expanded_[node])) return;
        if (static_cast<double>(values_[node]) + restFrom(node) > most_J_) {
          changeAround(node);
          return;
        }
        if ((++taken_ & 4095U) == 0 && stop_()) stopped = true;
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

void SubSolution::expand(std::uint32_t node) {
  const maps::Cell at = mesh_.positionOf(node);
  if (node >= mesh_.corners()) {
    fromMiddle(at);
    return;
  }
  fromCorner({at.column, at.row}, 0);
  fromCorner({at.column - 1, at.row}, 1);
  fromCorner({at.column - 1, at.row - 1}, 2);
  fromCorner({at.column, at.row - 1}, 3);
}

void SubSolution::fromCorner(maps::Cell cell, std::size_t corner) {
  Slot* slot = slotOf(cell);
  if (slot == nullptr) return;
  change(static_cast<std::uint32_t>(slot - slots_.data()));
  const TrianglePrices& prices = prices_[slot->prices];
  const CellMesh::Nodes nodes = mesh_.nodesOf(cell);
  const std::size_t after = CellMesh::next(corner), before = (corner + 3) % 4;
  const float middle = values_[nodes[CellMesh::kMiddle]];
  const TrianglePrices::Values left{values_[nodes[corner]], values_[nodes[after]], middle},
      right{values_[nodes[before]], values_[nodes[corner]], middle};
  const float share = slot->share[corner], other = slot->share[before];
  lower(nodes[after], prices.second(corner, share, left));
  lower(nodes[before], prices.first(before, other, right));
  lower(nodes[CellMesh::kMiddle],
        std::min(prices.middle(corner, share, left), prices.middle(before, other, right)));
}

void SubSolution::fromMiddle(maps::Cell cell) {
  Slot* slot = slotOf(cell);
  if (slot == nullptr) return;
  change(static_cast<std::uint32_t>(slot - slots_.data()));
  const TrianglePrices& prices = prices_[slot->prices];
  const CellMesh::Nodes nodes = mesh_.nodesOf(cell);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t first = nodes[k], second = nodes[CellMesh::next(k)];
    const TrianglePrices::Values values{values_[first], values_[second], values_[nodes[CellMesh::kMiddle]]};
    lower(first, prices.first(k, slot->share[k], values));
    lower(second, prices.second(k, slot->share[k], values));
  }
}

void SubSolution::change(std::uint32_t slot) {
  if (slots_[slot].changed) return;
  slots_[slot].changed = true;
  changed_.push_back(slot);
}

// The cells about a node that the search came to.
void SubSolution::changeAround(std::uint32_t node) {
  const maps::Cell at = mesh_.positionOf(node);
  const bool corner = node < mesh_.corners();
  for (const int row : {at.row, at.row - 1})
    for (const int column : {at.column, at.column - 1}) {
      if (!corner && !(row == at.row && column == at.column)) continue;
      if (!mesh_.grid().contains({column, row})) continue;
      if (const std::uint32_t slot = slot_of_[indexOf({column, row})]; slot < kClosed) change(slot);
    }
}

// Lowers prices behind the front until no triangle exceeds a limit; false when stopped.
bool SubSolution::settle(std::uint64_t end) {
  for (const std::uint32_t slot : ahead_) change(slot);
  ahead_.clear();
  for (int round = 0; round < kMostRounds && lowerPrices(end == kEnd); ++round)
    if (!search(end, ~std::size_t{0})) return false;
  return true;
}

// Whether any triangle exceeded a limit. Of triangles that the front has not passed only if all are asked for.
bool SubSolution::lowerPrices(bool all) {
  std::vector<Lowered> lowered;
  std::vector<std::uint32_t> looked_at;
  looked_at.swap(changed_);
  for (const std::uint32_t i : looked_at) {
    Slot& slot = slots_[i];
    slot.changed = false;
    const TrianglePrices& prices = prices_[slot.prices];
    const CellMesh::Nodes nodes = mesh_.nodesOf(slot.cell);
    bool is_ahead = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t first = nodes[k], second = nodes[CellMesh::next(k)],
                          middle = nodes[CellMesh::kMiddle];
      const int inners = inner(first) + inner(second) + inner(middle);
      is_ahead = is_ahead || (!all && inners < 3);
      if (inners < (all ? 1 : 3)) continue;
      const auto fall = TrianglePrices::fall(k, {values_[first], values_[second], values_[middle]});
      if (!prices.exceeds(fall, 1.0F + kSlack)) continue;
      slot.share[k] = std::min(slot.share[k], prices.excessFromNodes(k, fall)) / prices.excess(fall);
      lowered.push_back({i, static_cast<std::uint32_t>(k)});
    }
    if (is_ahead) ahead_.push_back(i);
  }
  if (!lowered.empty()) queue_.startAt(0);
  for (const Lowered& triangle : lowered) search(triangle);
  return !lowered.empty();
}

// What follows of a triangle whose prices were lowered.
void SubSolution::search(const Lowered& triangle) {
  change(triangle.slot);
  const Slot& slot = slots_[triangle.slot];
  const TrianglePrices& prices = prices_[slot.prices];
  const CellMesh::Nodes nodes = mesh_.nodesOf(slot.cell);
  const std::size_t k = triangle.triangle;
  const std::uint32_t first = nodes[k], second = nodes[CellMesh::next(k)], middle = nodes[CellMesh::kMiddle];
  const TrianglePrices::Values values{values_[first], values_[second], values_[middle]};
  lower(first, prices.first(k, slot.share[k], values));
  lower(second, prices.second(k, slot.share[k], values));
  lower(middle, prices.middle(k, slot.share[k], values));
}

}  // namespace talus::planner
