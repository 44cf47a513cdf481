#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Cells of the best way from a cell to a goal, both included, by what is left to pay from each: of equal
/// ways the one whose headings come first. distance(index) is exact or the largest number, atGoal(index) is
/// what is left to pay at a goal there or the largest number. Empty when there is no way.
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
