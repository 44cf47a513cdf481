#include <cmath>
#include <limits>

#include <planner/grid_links.hpp>
#include <planner/grid_route.hpp>

namespace talus::planner {
namespace {

// The link through which the goal is reached cheapest; nothing when none reaches it.
const GridLink* bestLink(const std::vector<GridLink>& links, const CostToGo& field) {
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

}  // namespace

Polyline gridRoute(const MotionCost& cost, CostToGo& field, const Segment& places, const StopCheck& stop) {
  const auto links = linksFrom(cost, places.from);
  for (const GridLink& link : links)
    if (!field.settle(link.cell, stop)) return {};
  const GridLink* link = bestLink(links, field);
  if (!link) return {};
  Polyline points{places.from};
  for (const maps::Cell cell : field.path(link->cell)) append(points, {cost.map().grid().centre(cell)});
  if (std::isfinite(cost({points.back(), places.to}))) append(points, {places.to});
  return points;
}

}  // namespace talus::planner
