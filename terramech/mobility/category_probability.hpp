#pragma once

#include <array>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// Uncertain state of a wheel at the reference slip. Drawbar pull over load DP/W and sinkage over radius z/r
/// are jointly Gaussian; torque and slip are exact.
struct ConditionEstimate {
  WheelCondition mean;                      ///< state of the wheel, with the means of DP/W and z/r
  double drawbar_pull_over_load_std = 0.0;  ///< standard deviation of DP/W [-], >= 0; 0: exactly known
  double sinkage_over_radius_std = 0.0;     ///< standard deviation of z/r [-], >= 0; 0: exactly known
  double correlation = 0.0;                 ///< correlation of DP/W and z/r in [-1, 1]; limited to +-0.999
};

/// Probabilities of the categories Safe, Marginal and Dangerous, in this order, with sum 1.
using CategoryProbability = std::array<double, 3>;

/// Returns the probability of each traversability category that categorise() can return for the uncertain
/// state of a wheel (ours; the thesis proposes fuzzy sets as future work). The error is below 1e-6 for
/// |correlation| <= 0.999. Throws std::invalid_argument if DP/W, z/r, a standard deviation, the correlation
/// or a limit is outside its range or NaN.
CategoryProbability categoryProbability(const ConditionEstimate& belief,
                                        const CategoryThresholds& thresholds);

/// Rectangle x1 <= X < x2, y1 <= Y < y2 in the plane of two standard normal variables X and Y with the given
/// correlation. The bounds may be infinite. probability() returns the probability that (X, Y) is in the
/// rectangle.
struct NormalRectangle {
  double x1, x2, y1, y2, correlation;  ///< bounds and correlation [-]
};
double probability(const NormalRectangle& rectangle);

}  // namespace talus::terramech
