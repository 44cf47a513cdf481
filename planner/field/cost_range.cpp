#include <algorithm>
#include <cmath>
#include <cstddef>

#include <talus/planner/field/cost_range.hpp>

namespace talus::planner {

CostRange costRange(const costmap::TravelCost& cost) {
  CostRange range;
  constexpr int kBins = costmap::TravelCurve::kBins;
  for (const auto& curve : cost.curves())
    for (int i = 0; i < (curve.lastRow() + 1) * kBins; ++i) {
      const auto value = static_cast<double>(curve.rows()[i]);
      const double gradient = costmap::TravelCurve::gradient(i % kBins);
      // The node just beyond the limit is included, because costs between the last node within the limit and
      // that node are interpolated.
      if (!std::isfinite(value) || std::abs(gradient) >= cost.limits().max_along + 1.0 / 256) continue;
      range.least_J_per_m = std::min(range.least_J_per_m, value);
      range.most_J_per_m = std::max(range.most_J_per_m, value);
    }
  return range;
}

}  // namespace talus::planner
