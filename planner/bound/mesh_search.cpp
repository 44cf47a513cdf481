#include <algorithm>
#include <utility>

#include <talus/planner/bound/mesh_search.hpp>

namespace talus::planner {
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
