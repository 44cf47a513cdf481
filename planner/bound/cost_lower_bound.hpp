#pragma once

#include <array>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lower bound of the cost per metre on a cell, for every heading: level_J_per_m + tilt_J_per_m * (gradient
/// of the ground along the heading).
struct CostLowerBound {
  double level_J_per_m = 0.0;  ///< lower bound on level ground, >= 0
  double tilt_J_per_m = 0.0;   ///< increase of the lower bound per unit of gradient (rise over run)
};

/// Lower bounds of cost curves by straight lines: level + tilt * gradient is at most the cost for gradients
/// up to a given steepness. A cost curve (costmap::TravelCurve) is the cost per metre on one kind of ground
/// over the gradients along the heading (bins) and across it (rows). The tilt is the derivative of the cost
/// curve at level ground, halved until the line is positive for every heading. Only row 0 (no gradient
/// across) is used. Because costs never decrease from row to row, a bound of row 0 is a bound of all rows.
class CostLowerBounds {
 public:
  explicit CostLowerBounds(const costmap::TravelCost& cost);

  /// Returns a lower bound of the cost on a cell that allows some heading. The bound is valid for every
  /// heading.
  CostLowerBound of(costmap::CellCode cell) const noexcept;

  /// Returns the highest lower bound with tilt_J_per_m = 0, that is, one value for all headings.
  CostLowerBound level(costmap::CellCode cell) const noexcept;

  /// Returns the number of cost curves.
  std::size_t curves() const noexcept { return lines_.size(); }

 private:
  static constexpr int kReach = costmap::TravelCurve::kBins / 2;
  static int reachOf(costmap::CellCode cell) noexcept;

  std::vector<std::array<CostLowerBound, kReach + 1>> lines_;  // by cost curve, then by steepness in bins
  std::vector<std::array<double, kReach + 1>> levels_;
};

}  // namespace talus::planner
