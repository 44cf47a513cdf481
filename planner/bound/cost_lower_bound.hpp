#pragma once

#include <array>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lower bound of the drive cost of a cell: a metre in direction d costs at least level + tilt * (gradient
/// along d).
struct CostLowerBound {
  double level_J_per_m = 0.0;  ///< >= 0
  double tilt_J_per_m = 0.0;   ///< per unit gradient (rise over run)
};

/// Straight lines below each drive curve: level + tilt * gradient never exceeds the curve for gradients up to
/// a given steepness. The tilt is the slope of the curve at level ground, halved until the line is positive
/// for every heading. Only row 0 of a curve (no gradient across) is used: costs never decrease from row to
/// row (TravelCurve), so a bound of row 0 bounds all rows.
class CostLowerBounds {
 public:
  explicit CostLowerBounds(const costmap::TravelCost& cost);

  /// Returns a lower bound of the cost of an allowed cell that is valid for every heading.
  CostLowerBound of(costmap::CellCode cell) const noexcept;

  /// Returns the highest lower bound with tilt_J_per_m = 0.
  CostLowerBound level(costmap::CellCode cell) const noexcept;

  /// Returns the number of drive curves.
  std::size_t curves() const noexcept { return lines_.size(); }

 private:
  static constexpr int kReach = costmap::TravelCurve::kBins / 2;
  static int reachOf(costmap::CellCode cell) noexcept;

  std::vector<std::array<CostLowerBound, kReach + 1>> lines_;  // by curve, then by steepness in bins
  std::vector<std::array<double, kReach + 1>> levels_;
};

}  // namespace talus::planner
