#include <cmath>
#include <limits>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/field/patched_field.hpp>

namespace talus::planner {
namespace {

// Link with the lowest total cost to the goal; null if no link reaches the goal.
template <typename Field>
const GridLink* bestLink(const std::vector<GridLink>& links, const Field& field) {
  const GridLink* best = nullptr;
  double best_J = std::numeric_limits<double>::infinity();
  for (const GridLink& link : links) {
    const auto rest_J = field.cost_J(link.cell);
    if (!rest_J || link.cost_J + *rest_J >= best_J) continue;
    best_J = link.cost_J + *rest_J;
    best = &link;
  }
  return best;
}

// Descends a settled field from the best link to the goal.
template <typename Field>
Polyline downField(const MotionCost& cost, const Field& field, const std::vector<GridLink>& links,
                   const Segment& places) {
  const GridLink* link = bestLink(links, field);
  if (!link) return {};
  Polyline points{places.from};
  for (const maps::Cell cell : field.path(link->cell)) append(points, {cost.map().grid().centre(cell)});
  if (std::isfinite(cost({points.back(), places.to}))) append(points, {places.to});
  return points;
}

// Searching 1 of this many cells takes about as long as settling all cells.
constexpr std::uint64_t kSettledPerLookedAt = 8;

}  // namespace

Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places, const StopCheck& stop) {
  const auto links = linksFrom(cost, places.from);
  for (const GridLink& link : links)
    if (!field.settle(link.cell, stop)) return {};
  return downField(cost, field, links, places);
}

std::optional<Polyline> gridRouteAfter(CellBox changed, const MotionCost& cost, const CostToGo& before,
                                       const Segment& places, const StopCheck& stop) {
  const auto links = linksFrom(cost, places.from);
  PatchedField field(before, changed);
  const auto outcome = field.settle(links, before.edges().padded().size() / kSettledPerLookedAt, stop);
  if (outcome == PatchedField::Outcome::TooMuch) return std::nullopt;
  if (outcome == PatchedField::Outcome::Stopped) return Polyline{};
  return downField(cost, field, links, places);
}

}  // namespace talus::planner
