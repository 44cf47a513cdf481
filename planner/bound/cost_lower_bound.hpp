#pragma once

#include <array>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>

namespace talus::planner {

/// A norm below the drive cost of a cell: a metre in the direction d costs at least level + tilt * (gradient
/// along d).
struct CostLowerBound {
  double level_J_per_m = 0.0;  ///< >= 0
  double tilt_J_per_m = 0.0;   ///< per rise over run
};

/// The straight lines below each drive curve: for all gradients up to a steepest one, level + tilt * gradient
/// never exceeds the curve. The tilt is the curve's own at level ground, as far as the line stays positive
/// for every heading. Curves are those without anything across: in no bin does a cost fall from row to row
/// (DriveCurve), so what is below row 0 is below all.
class CostLowerBounds {
 public:
  explicit CostLowerBounds(const costmap::DriveCost& cost);

  /// The line for an allowed cell; it holds for every heading.
  CostLowerBound of(costmap::CellCode cell) const noexcept;

  /// The highest line without tilt.
  CostLowerBound level(costmap::CellCode cell) const noexcept;

  /// How many curves there are.
  std::size_t curves() const noexcept { return lines_.size(); }

 private:
  static constexpr int kReach = costmap::DriveCurve::kBins / 2;
  static int reachOf(costmap::CellCode cell) noexcept;

  std::vector<std::array<CostLowerBound, kReach + 1>> lines_;  // by curve and by bins to either side
  std::vector<std::array<double, kReach + 1>> levels_;
};

}  // namespace talus::planner
