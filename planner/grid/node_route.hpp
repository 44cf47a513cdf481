#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// What a search has in place of the number of a node: none.
inline constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();

/// The way between two places over the nodes of a search, of which `last` is the last: before(node) is the node that it was
/// reached from, kNoNode where that is the start, place(node) where it lies. Equal places in a row count once.
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
