#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

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

}  // namespace talus::planner
