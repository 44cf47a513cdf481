#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Returns the cells of the cheapest path from the cell `from` to a goal, including both, by following a
/// cost-to-go field; empty if there is no path. Of equally cheap paths, the first in the order of headings is
/// returned. distance(index) returns the exact cost to the goal in units for a padded index; atGoal(index)
/// returns the remaining cost if the cell is a goal. Both return the largest uint32 if there is no such
/// value.
template <typename Distance, typename AtGoal>
std::vector<maps::Cell> descent(const EdgeLayer& edges, maps::Cell from, Distance distance, AtGoal atGoal) {
  constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();
  const PaddedGrid& padded = edges.padded();
  std::vector<maps::Cell> path;
  std::size_t at = padded.index(from);
  std::uint32_t left = distance(at);
  if (left == kUnreached) return path;
  path.push_back(from);
  while (atGoal(at) != left) {
    const std::size_t before = at;
    for (int heading = 0; heading < 8 && at == before; ++heading) {
      const std::size_t next = before + static_cast<std::size_t>(padded.offset(heading));
      const std::uint16_t edge = edges.into(next)[opposite(heading)];
      if (edge == EdgeLayer::kBlocked || edge > left || distance(next) != left - edge) continue;
      at = next;
      left -= edge;
    }
    if (at == before) return {};  // not settled
    path.push_back(padded.cell(at));
  }
  return path;
}

}  // namespace talus::planner
