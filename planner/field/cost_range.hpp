#pragma once

#include <limits>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lowest and highest cost per metre over all cost curves (kinds of ground, costmap::TravelCurve) and all
/// allowed gradients along and across the heading.
struct CostRange {
  /// Lowest cost; infinite if no motion is allowed.
  double least_J_per_m = std::numeric_limits<double>::infinity();
  double most_J_per_m = 0.0;  ///< highest finite cost
};
/// Returns the cost range of a cost function.
CostRange costRange(const costmap::TravelCost& cost);

}  // namespace talus::planner
