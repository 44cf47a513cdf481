#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Index of a missing node.
inline constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();

/// Polyline between two places over the nodes of a search, ending at node `last`. before(node) is the
/// predecessor of a node, kNoNode at the start; place(node) is its position. Consecutive equal places are
/// merged.
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
