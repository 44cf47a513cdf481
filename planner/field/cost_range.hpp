#pragma once

#include <limits>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lowest and highest drive cost per metre over all curves and all allowed gradients along and across.
struct CostRange {
  double least_J_per_m = std::numeric_limits<double>::infinity();  ///< infinite if no motion is allowed
  double most_J_per_m = 0.0;
};
CostRange costRange(const costmap::TravelCost& cost);

}  // namespace talus::planner
