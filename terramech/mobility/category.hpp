#pragma once

#include <array>
#include <optional>

#include <talus/terramech/contact/wheel_on_soil.hpp>

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

/// Throws std::invalid_argument that names the limit if a limit is not finite, or if a lower limit exceeds its
/// upper limit.
void validate(const CategoryThresholds& thresholds);

/// Returns the traversability category of a wheel by the rule of thesis 3.5, with its strict inequalities.
/// DP/W < dp_low is dangerous, DP/W > dp_high is safe, and other DP/W is marginal. Then z/r > z_critical is
/// dangerous, z/r < z_threshold causes no change, and other z/r moves the category one level down. T/(rW) has
/// the rule of z/r with its own limits. The thesis does not specify how the level reductions by sinkage and
/// by torque combine; here the reductions add. The category is Unknown if a given number is NaN.
Category categorise(const WheelCondition& condition, const CategoryThresholds& thresholds);

/// Drawbar pull over load DP/W and sinkage over radius z/r of a wheel, independent normal estimates [-].
struct UncertainWheel {
  Estimate drawbar_pull_over_load, sinkage_over_radius;
};

/// Probabilities of the categories Safe, Marginal and Dangerous, in this order, with sum 1.
using CategoryProbability = std::array<double, 3>;

/// Returns the probability of each category that categorise() can return for an uncertain wheel (ours; the
/// thesis proposes fuzzy sets as future work). A standard deviation of 0 states an exact value. Throws
/// std::invalid_argument if an estimate is NaN or a standard deviation negative.
CategoryProbability categoryProbability(const UncertainWheel& wheel, const CategoryThresholds& thresholds);

}  // namespace talus::terramech
