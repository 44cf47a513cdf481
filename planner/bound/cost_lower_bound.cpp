#include <algorithm>
#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/cost_lower_bound.hpp>

namespace talus::planner {
namespace {

using costmap::TravelCurve;

constexpr int kMiddle = TravelCurve::kBins / 2;
constexpr double kBinWidth = 1.0 / 256.0;
// A tilted line stays above this share of its level for every heading, so that every step has a positive
// cost.
constexpr double kLeastShare = 0.1;

double valueAt(const TravelCurve& curve, int bin) noexcept {
  const int at = bin + kMiddle;
  return at >= 0 && at < TravelCurve::kBins
             ? static_cast<double>(curve.cost_J_per_m[static_cast<std::size_t>(at)])
             : kInfinity;
}

// Highest level of a line with this tilt that stays below the curve. The curve is linear between nodes, so
// nodes suffice.
double levelUnder(const TravelCurve& curve, int reach, double tilt) noexcept {
  double level = kInfinity;
  for (int bin = -reach; bin <= reach; ++bin)
    level = std::min(level, valueAt(curve, bin) - tilt * bin * kBinWidth);
  return level;
}

// Slope of the curve at level ground: of the chord from 4 bins below to 4 bins above.
double tiltOf(const TravelCurve& curve) noexcept {
  const double rise = valueAt(curve, 4) - valueAt(curve, -4);
  return std::isfinite(rise) ? rise / (8 * kBinWidth) : 0.0;
}

CostLowerBound lineUnder(const TravelCurve& curve, int reach) noexcept {
  CostLowerBound best{std::max(levelUnder(curve, reach, 0.0), 0.0), 0.0};
  if (!std::isfinite(best.level_J_per_m)) return best;
  const double steepest = reach * kBinWidth;
  for (double share = 1.0; share > 0.1; share /= 2) {
    const double tilt = share * tiltOf(curve), level = levelUnder(curve, reach, tilt);
    if (level * (1.0 - kLeastShare) * 0.92 < std::abs(tilt) * steepest) continue;
    return {level, tilt};
  }
  return best;
}

}  // namespace

CostLowerBounds::CostLowerBounds(const costmap::TravelCost& cost)
    : lines_(cost.curves().size()), levels_(cost.curves().size()) {
  for (std::size_t k = 0; k < lines_.size(); ++k)
    for (std::size_t reach = 0; reach <= kReach; ++reach) {
      lines_[k][reach] = lineUnder(cost.curves()[k], static_cast<int>(reach));
      levels_[k][reach] = std::max(levelUnder(cost.curves()[k], static_cast<int>(reach), 0.0), 0.0);
    }
}

int CostLowerBounds::reachOf(costmap::CellCode cell) noexcept {
  const double steepest = std::hypot(cell.dzDx(), cell.dzDy());
  return std::min(static_cast<int>(std::ceil(steepest / kBinWidth)), kReach);
}

CostLowerBound CostLowerBounds::of(costmap::CellCode cell) const noexcept {
  const int reach = reachOf(cell);
  // Steeper than the curve's range: no tilt is proven to stay below the cost.
  if (reach == kReach) return level(cell);
  return lines_[cell.curve()][static_cast<std::size_t>(reach)];
}

CostLowerBound CostLowerBounds::level(costmap::CellCode cell) const noexcept {
  return {levels_[cell.curve()][static_cast<std::size_t>(reachOf(cell))], 0.0};
}

}  // namespace talus::planner
