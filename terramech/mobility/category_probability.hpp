#pragma once

#include <array>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// Estimate of a wheel at the reference slip: DP/W and z/r are jointly Gaussian, torque and slip are exact.
struct ConditionEstimate {
  WheelCondition mean;                      ///< drawbar pull and sinkage are means
  double drawbar_pull_over_load_std = 0.0;  ///< [-] >= 0; 0: exactly known
  double sinkage_over_radius_std = 0.0;     ///< [-] >= 0; 0: exactly known
  double correlation = 0.0;                 ///< of DP/W and z/r, in [-1, 1]; limited to +-0.999
};

/// Probabilities of Safe, Marginal and Dangerous, with sum 1.
using CategoryProbability = std::array<double, 3>;

/// Returns the probability of each category of categorise() (ours; the thesis proposes fuzzy sets as future
/// work). Error below 1e-6 for |correlation| <= 0.999. Throws std::invalid_argument if DP/W, z/r, a standard
/// deviation, the correlation or a limit is outside its range or NaN.
CategoryProbability categoryProbability(const ConditionEstimate& belief,
                                        const CategoryThresholds& thresholds);

/// Rectangle x1 <= X < x2, y1 <= Y < y2 for standard normal X, Y with a correlation; bounds may be infinite.
/// probability() returns its probability.
struct NormalRectangle {
  double x1, x2, y1, y2, correlation;
};
double probability(const NormalRectangle& rectangle);

}  // namespace talus::terramech
