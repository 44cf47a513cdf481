#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <talus/planner/bound/cheapest_metre.hpp>

namespace talus::planner {

double cheapestMetre_J(const costmap::CostGrid& map) {
  std::vector<bool> used(std::size_t{costmap::CellCode::kBlocked} + 1);
  for (std::size_t i = 0; i < map.content().tiles.size(); ++i)
    for (const costmap::CellCode cell : map.content().tiles.tile(i).cells) used[cell.curve()] = true;
  float cheapest = std::numeric_limits<float>::infinity();
  const auto& curves = map.cost().curves();
  for (std::size_t k = 0; k < curves.size(); ++k)
    if (used[k]) cheapest = std::min(cheapest, *std::ranges::min_element(curves[k].cost_J_per_m));
  return std::isfinite(cheapest) ? static_cast<double>(std::max(cheapest, 0.0F)) : 0.0;
}

}  // namespace talus::planner
