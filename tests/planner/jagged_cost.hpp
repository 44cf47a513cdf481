#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "drawn_map.hpp"

namespace talus::planner::testing {

/// Curves of many shapes, with bends, jumps and gaps.
inline std::shared_ptr<const costmap::TravelCost> jaggedCost() {
  std::mt19937 random(7);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<costmap::TravelCurve> curves;
  for (int k = 0; k < 6; ++k) {
    std::vector<float> costs = *curve({.factor = 1.0 + k, .steepest = 0.1 + 0.1 * k}).costs;
    for (float& value : costs) value *= static_cast<float>(1.0 + 0.3 * k * unit());
    if (k > 3) costs[static_cast<std::size_t>(costmap::TravelCurve::kBins / 2 + 7 * k)] = INFINITY;
    const costmap::TravelCurve made(std::move(costs));
    curves.push_back(k % 2 == 0 ? made : crossed(made, 0.05 * k, 22 - k));
  }
  return std::make_shared<costmap::TravelCost>(
      costmap::TravelCost::Limits{.max_along = 0.5, .max_across = 0.4}, curves);
}

}  // namespace talus::planner::testing
