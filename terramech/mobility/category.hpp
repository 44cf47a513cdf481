#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace talus::terramech {

/// Traversability categories of the ground under a wheel, from the wheel's state at a reference slip (thesis
/// 3.5).

/// Traversability category of the ground, from best to worst. Unknown: the data do not suffice for a
/// category.
enum class Category { Safe, Marginal, Dangerous, Unknown };

/// Returns "safe", "marginal", "dangerous" or "unknown".
const char* name(Category category);

/// State of a wheel at the reference slip, with load W, radius r, drawbar pull DP, torque T and sinkage z.
struct WheelCondition {
  double drawbar_pull_over_load = 0.0;  ///< drawbar pull over load, DP/W [-]
  double sinkage_over_radius = 0.0;     ///< sinkage over radius, z/r [-]
  /// Torque ratio T/(rW) [-]; empty: the torque criterion is not applied.
  std::optional<double> torque_over_load_radius = {};
  std::optional<double> slip = {};  ///< driven slip, [-1, 1]; empty: the steering criterion is not applied
};

/// Limits between the traversability categories. A criterion without limits is not applied. A category that
/// moves one level down changes from safe to marginal, or from marginal to dangerous.
struct CategoryThresholds {
  double dp_low = 0.0;       ///< DP/W below this limit is dangerous
  double dp_high = 0.0;      ///< DP/W above this limit is safe; DP/W in [dp_low, dp_high] is marginal
  double z_threshold = 0.5;  ///< z/r at or above this limit moves the category one level down
  double z_critical = 0.75;  ///< z/r above this limit is dangerous
  /// T/(rW) at or above this limit moves the category one level down.
  std::optional<double> t_threshold = {};
  std::optional<double> t_critical = {};  ///< T/(rW) above this limit is dangerous
  /// Slip above this limit is dangerous, because the wheel cannot be steered (ours).
  std::optional<double> steering_slip = {};
};

/// Slope of a mission, from which thresholds() derives the drawbar-pull limits.
struct MissionSlope {
  double slope_rad = 0.0;   ///< steepest slope that the rover must climb, [0, pi/2)
  double margin_rad = 0.0;  ///< uncertainty (+-) of that slope, >= 0
};

/// Returns the limits dp_low = tan(slope - margin) and dp_high = tan(slope + margin), with defaults for the
/// other limits. In thesis 3.5 a slope of 15 deg +- 5 deg gives tan 10 deg and tan 20 deg. Throws
/// std::invalid_argument unless slope >= 0, margin >= 0 and slope + margin < pi/2.
CategoryThresholds thresholds(const MissionSlope& mission);

/// Throws std::invalid_argument that names the limit if a limit is not finite, if a lower limit exceeds its
/// upper limit, or if steering_slip is outside [0, 1].
void validate(const CategoryThresholds& thresholds);

/// Returns the traversability category of a wheel by the rule of thesis 3.5, with its strict inequalities.
/// DP/W < dp_low is dangerous, DP/W > dp_high is safe, and other DP/W is marginal. Then z/r > z_critical is
/// dangerous, z/r < z_threshold causes no change, and other z/r moves the category one level down. T/(rW) has
/// the rule of z/r with its own limits. The thesis does not specify how the level reductions by sinkage and
/// by torque combine; here the reductions add. The category is Unknown if a given number is NaN.
Category categorise(const WheelCondition& condition, const CategoryThresholds& thresholds);

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
