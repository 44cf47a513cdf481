#pragma once

#include <array>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// The estimate of a wheel at the reference slip: DP/W and z/r Gaussian; torque and slip as they are.
struct ConditionBelief {
  WheelCondition mean;                      ///< its drawbar pull and sinkage are means
  double drawbar_pull_over_load_std = 0.0;  ///< [-] >= 0; 0: known
  double sinkage_over_radius_std = 0.0;     ///< [-] >= 0; 0: known
  double correlation = 0.0;                 ///< of the two, (-1, 1)
};

/// Probabilities of Safe, Marginal and Dangerous; they add up to 1.
using CategoryProbability = std::array<double, 3>;

/// How likely each category of categorise() is under the belief: what the thesis' future work leaves to fuzzy
/// sets. Error below 1e-6 for |correlation| <= 0.999. Throws std::invalid_argument when a field leaves its
/// range or is NaN.
CategoryProbability categoryProbability(const ConditionBelief& belief, const CategoryThresholds& thresholds);

/// P(x1 <= X < x2, y1 <= Y < y2) for standard normal X, Y of that correlation; bounds may be infinite.
struct NormalRectangle {
  double x1, x2, y1, y2, correlation;
};
double probability(const NormalRectangle& rectangle);

}  // namespace talus::terramech
