#pragma once

#include <limits>

#include <talus/costmap/cost/drive_cost.hpp>

namespace talus::planner {

/// The cheapest and the dearest metre on any ground, of all gradients along and across that are allowed.
struct CostRange {
  double least_J_per_m = std::numeric_limits<double>::infinity();  ///< infinite where nothing is allowed
  double most_J_per_m = 0.0;
};
CostRange costRange(const costmap::DriveCost& cost);

}  // namespace talus::planner
