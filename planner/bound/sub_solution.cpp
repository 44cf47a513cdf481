#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/planner/bound/sub_solution.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kBand = 16;  // nodes taken by the search between two checks of the limits
// Rounds of lowering behind the front; remaining violations are left to provenBy().
constexpr int kMostRounds = 60;
constexpr float kSlack = 5e-4F;   // relative tolerance of a triangle's limits
constexpr double kWithin = 1.02;  // nodes within this multiple of the known cost are searched

}  // namespace

SubSolution::SubSolution(const Parts& parts, DirectionalCostBounds& limits, std::size_t quota,
                         const StopCheck& stop)
    : parts_(parts),
      stop_(stop),
      quota_(quota),
      prices_(parts.map, limits),
      from_start_(prices_, {.way = MeshSearch::Way::ToNode, .cheapest_J = parts.cheapest_J}),
      to_goal_(
          prices_,
          {.cheapest_J = parts.cheapest_J, .rest = &parts.from_start, .most_J = kWithin * parts.most_J}) {
  seedStart();
  from_start_.run(MeshSearch::kEnd, quota, stop_);
  parts_.goal_tolerance_m > 0.0 ? seedDisc() : seedPlane();
  while (!to_goal_.done() && work() < quota)
    if (!to_goal_.run(MeshSearch::kEnd, to_goal_.taken() + kBand, stop_) || !settle(false)) break;
  settle(true);
}

const TriangleCosts* SubSolution::pricesOf(maps::Cell cell) const noexcept {
  const std::uint32_t slot = prices_.knownSlotOf(cell);
  return slot == MeshCosts::kNone ? nullptr : &prices_.of(slot);
}

// The proof does not depend on these values.
void SubSolution::seedStart() {
  const auto cell = mesh().grid().cellAt(parts_.places.from);
  if (!cell || prices_.slotOf(*cell) == MeshCosts::kNone) return;
  for (const std::uint32_t node : mesh().nodesOf(*cell)) from_start_.lower(node, 0.0F);
}

// A route may end anywhere in the disc.
void SubSolution::seedDisc() {
  for (const maps::Cell cell : cellsWithin(mesh().grid(), parts_.places.to, parts_.goal_tolerance_m))
    if (prices_.slotOf(cell) != MeshCosts::kNone)
      for (const std::uint32_t node : mesh().nodesOf(cell)) to_goal_.lower(node, 0.0F);
}

// Seeds the goal's cell with a plane: 0 at the goal, falling along the straight line from the start at the
// limits.
void SubSolution::seedPlane() {
  const maps::Point goal = parts_.places.to;
  const auto cell = mesh().grid().cellAt(goal);
  const std::uint32_t slot = cell ? prices_.slotOf(*cell) : MeshCosts::kNone;
  if (slot == MeshCosts::kNone) return;
  constexpr double sector = 2.0 * std::numbers::pi / DirectionalCostBounds::kHeadings;
  const double angle = std::atan2(goal.y_m - parts_.places.from.y_m, goal.x_m - parts_.places.from.x_m) +
                       2.0 * std::numbers::pi;
  const int k = static_cast<int>(angle / sector) % DirectionalCostBounds::kHeadings;
  const costmap::Direction a = DirectionalCostBounds::heading(k), b = DirectionalCostBounds::heading(k + 1);
  const auto& prices = prices_.of(slot).prices;
  const auto at_a = static_cast<double>(prices[static_cast<std::size_t>(k)]),
             at_b = static_cast<double>(prices[static_cast<std::size_t>(k) + 1]);
  const double scale = 1.0 / (std::sin(sector) * mesh().grid().resolution_m);
  const double fall_x = (at_a * b.y - at_b * a.y) * scale, fall_y = (at_b * a.x - at_a * b.x) * scale;
  to_goal_.startAt(-2.0 * std::hypot(fall_x, fall_y) * mesh().grid().resolution_m);
  for (const std::uint32_t node : mesh().nodesOf(*cell)) {
    const maps::Point place = mesh().placeOf(node);
    to_goal_.lower(node,
                   static_cast<float>(fall_x * (goal.x_m - place.x_m) + fall_y * (goal.y_m - place.y_m)));
  }
}

// Caps violations behind the front until none is left or kMostRounds is reached. Returns false when stopped.
bool SubSolution::settle(bool all) {
  // Triangles that the front has not passed change later; triangles that the front never passes are checked
  // at the end.
  if (all)
    for (std::size_t slot = 0; slot < prices_.slots(); ++slot)
      to_goal_.change(static_cast<std::uint32_t>(slot));
  const std::uint64_t end = to_goal_.done() ? MeshSearch::kEnd : to_goal_.front();
  for (int round = 0; round < kMostRounds && lowerExcess(all); ++round)
    if (!to_goal_.run(end, quota_, stop_) || work() >= quota_) return false;
  return true;
}

// Caps and relaxes triangles that exceed a limit. Returns true if any value was lowered. Triangles that the
// front has not passed completely are included only if `all` is true.
bool SubSolution::lowerExcess(bool all) {
  std::vector<std::pair<std::uint32_t, std::size_t>> over;
  const std::vector<std::uint32_t> changed = to_goal_.takeChanged();
  checked_ += changed.size();
  for (const std::uint32_t slot : changed) {
    const CellMesh::Nodes nodes = mesh().nodesOf(prices_.cellOf(slot));
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t first = nodes[k], second = nodes[CellMesh::next(k)],
                          middle = nodes[CellMesh::kMiddle];
      if (inner(first) + inner(second) + inner(middle) < (all ? 1 : 3)) continue;
      const auto fall = TriangleCosts::fall(k, {at(first), at(second), at(middle)});
      if (prices_.of(slot).exceeds(fall, 1.0F + kSlack)) over.emplace_back(slot, k);
    }
  }
  bool lowered = false;
  for (const auto& [slot, triangle] : over) {
    cap(slot, triangle);
    lowered = to_goal_.relax(slot, triangle) || lowered;
  }
  return lowered;
}

// Adds caps for motions from a side to the opposite node whose fall exceeds their cost.
void SubSolution::cap(std::uint32_t slot, std::size_t triangle) {
  const CellMesh::Nodes all = mesh().nodesOf(prices_.cellOf(slot));
  const std::array<std::uint32_t, 3> nodes{all[triangle], all[CellMesh::next(triangle)],
                                           all[CellMesh::kMiddle]};
  const TriangleCosts::Values values{at(nodes[0]), at(nodes[1]), at(nodes[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    const float wanted = std::max(from_start_.at(nodes[k]) - from_start_.at(nodes[k == 0 ? 1 : 0]), 0.0F);
    if (const auto rise = prices_.of(slot).lowered(triangle, k, values, wanted, 0.5F * kSlack))
      to_goal_.cap(slot, triangle, k, *rise);
  }
}

}  // namespace talus::planner
