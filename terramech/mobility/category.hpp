#pragma once

#include <optional>

/// Traversability categories of the ground under a wheel (thesis 3.5).
namespace talus::terramech {

/// Traversability category, best first. Unknown: the data are insufficient for a category.
enum class Category { Safe, Marginal, Dangerous, Unknown };

/// Returns "safe", "marginal", "dangerous" or "unknown".
const char* name(Category category);

/// State of a wheel at the reference slip.
struct WheelCondition {
  double drawbar_pull_over_load = 0.0;  ///< DP/W [-]
  double sinkage_over_radius = 0.0;     ///< z/r [-]
  std::optional<double> torque_over_load_radius =
      {};                           ///< T/(rW) [-]; empty: the torque criterion is not applied
  std::optional<double> slip = {};  ///< driven slip, [-1, 1]; empty: the steering limit is not applied
};

/// Limits between the categories. A criterion without limits is not applied.
struct CategoryThresholds {
  double dp_low = 0.0;                     ///< lower DP/W is dangerous
  double dp_high = 0.0;                    ///< higher DP/W is safe; between dp_low and dp_high marginal
  double z_threshold = 0.5;                ///< at or above this z/r the category drops one level
  double z_critical = 0.75;                ///< higher z/r is dangerous
  std::optional<double> t_threshold = {};  ///< at or above this T/(rW) the category drops one level
  std::optional<double> t_critical = {};   ///< higher T/(rW) is dangerous
  /// Higher slip is dangerous, because the wheel cannot be steered (ours).
  std::optional<double> steering_slip = {};
};

/// Slopes that determine the drawbar-pull thresholds.
struct MissionSlope {
  double slope_rad = 0.0;   ///< steepest slope that the mission must climb, [0, pi/2)
  double margin_rad = 0.0;  ///< uncertainty of the slope, plus or minus, >= 0
};

/// Returns dp_low = tan(slope - margin), dp_high = tan(slope + margin) (thesis 3.5: 15 deg +- 5 deg gives tan
/// 10 deg, tan 20 deg), with defaults for the other limits. Throws std::invalid_argument unless slope >= 0,
/// margin >= 0 and slope + margin < pi/2.
CategoryThresholds thresholds(const MissionSlope& mission);

/// Throws std::invalid_argument with the limit that is not finite or exceeds its upper limit, or if
/// steering_slip is outside [0, 1].
void validate(const CategoryThresholds& thresholds);

/// Returns the category by the rule of thesis 3.5, with its strict inequalities: DP/W < dp_low dangerous, >
/// dp_high safe, otherwise marginal; z > critical dangerous, z < threshold no change, otherwise one level
/// down; the torque has the same rule with its own thresholds. The level reductions by sinkage and by torque
/// are not specified in the thesis. The category is Unknown if a given number is NaN.
Category categorise(const WheelCondition& condition, const CategoryThresholds& thresholds);

}  // namespace talus::terramech
