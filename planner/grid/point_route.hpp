#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>

#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Node index that means "no node".
inline constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();

/// Returns the polyline from `ends.from` over the nodes of a search to `ends.to`; `last` is the last node.
/// before(node) returns the predecessor of a node, kNoNode for the first node; place(node) returns its
/// position. Consecutive equal positions are merged.
template <typename Before, typename Place>
Polyline nodeRoute(const Segment& ends, std::uint32_t last, Before before, Place place) {
  Polyline points{ends.to};
  for (std::uint32_t at = last; at != kNoNode; at = before(at)) points.push_back(place(at));
  points.push_back(ends.from);
  std::ranges::reverse(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Estimate of the cost [J] from a place to the goal.
using Rest = std::function<double(maps::Point)>;

/// Returns the cheapest route from `places.from` to `places.to`, or to within `tolerance_m` of it, over fixed
/// points of cells: 7 points on each side, and 9 points inside each cell that does not allow some heading, so
/// that a route can tack (alternate between two headings) there. Maps of more than 20,000 cells have 3 and 1
/// points; maps of up to 1,000 cells have 15 and 25. Maps of up to 5,000 cells also have 15 and 25 points if
/// the first search found no route. A leg crosses one cell or a part of one cell at its exact cost. The cost
/// of a turn at a point is that of the cheapest leg to this point. The search finds corridors that grids with
/// few headings miss, especially where cells allow few headings; the route is meant to be refined. The method
/// is A* with the estimate `rest`, or a straight-line lower bound without it. Routes that cost `most_J` [J] or more are not searched. The result
/// is empty if there is no cheaper route, or after a stop.
Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop = {}, const Rest& rest = {});

}  // namespace talus::planner
