#include <algorithm>
#include <cmath>
#include <limits>

#include <planner/lower_bound.hpp>

namespace talus::planner {

double lowerBound_J(const costmap::CostGrid& map, const Segment& places) {
  double cheapest = std::numeric_limits<double>::infinity();
  for (const auto& curve : map.cost().curves())
    for (const float value : curve.cost_J_per_m) cheapest = std::min(cheapest, static_cast<double>(value));
  const double metres = std::hypot(places.to.x_m - places.from.x_m, places.to.y_m - places.from.y_m);
  return std::isfinite(cheapest) ? cheapest * metres : 0.0;
}

}  // namespace talus::planner
