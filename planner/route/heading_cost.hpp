#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Cost per metre for a fixed heading, for loops over many cells. The values are bit-identical to those of
/// TravelCost::costPerMetre(). The TravelCost must outlive the object.
class HeadingCost {
 public:
  HeadingCost(const costmap::TravelCost& cost, costmap::Direction heading) noexcept
      : HeadingCost(cost, heading.x * costmap::CellCode::kStep, heading.y * costmap::CellCode::kStep) {}

  /// (x, y) is the unit vector of the heading times CellCode::kStep.
  HeadingCost(const costmap::TravelCost& cost, double x, double y) noexcept
      : curves_(cost.curves().data()),
        curve_count_(cost.curves().size()),
        max_along_(cost.limits().max_along),
        max_across_(cost.limits().max_across),
        x_(x),
        y_(y) {}

  /// Returns the cost per horizontal metre [J/m] on a cell; infinite if the cell does not permit the heading.
  float operator()(costmap::CellCode cell) const noexcept {
    if (cell.curve() >= curve_count_) return kBlocked;
    const double along = cell.stepsX() * x_ + cell.stepsY() * y_;
    const double across = cell.stepsY() * x_ - cell.stepsX() * y_;
    if (!(std::abs(along) <= max_along_ && std::abs(across) <= max_across_)) return kBlocked;
    return curves_[cell.curve()].price(along, across);
  }

 private:
  static constexpr float kBlocked = std::numeric_limits<float>::infinity();

  const costmap::TravelCurve* curves_;
  std::size_t curve_count_;
  double max_along_, max_across_;
  double x_, y_;  // unit vector of the heading times CellCode::kStep
};

}  // namespace talus::planner
