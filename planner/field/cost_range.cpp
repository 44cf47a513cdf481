#include <algorithm>
#include <cmath>
#include <cstddef>

#include <talus/planner/field/cost_range.hpp>

namespace talus::planner {

CostRange costRange(const costmap::DriveCost& cost) {
  CostRange range;
  for (const auto& curve : cost.curves())
    for (int bin = 0; bin < costmap::DriveCurve::kBins; ++bin) {
      const auto value = static_cast<double>(curve.cost_J_per_m[static_cast<std::size_t>(bin)]);
      const double gradient = (bin - costmap::DriveCurve::kBins / 2) / 256.0;
      if (!std::isfinite(value) || std::abs(gradient) > cost.limits().max_along + 1.0 / 512) continue;
      range.least_J_per_m = std::min(range.least_J_per_m, value);
      range.most_J_per_m = std::max(range.most_J_per_m, value);
    }
  return range;
}

}  // namespace talus::planner
