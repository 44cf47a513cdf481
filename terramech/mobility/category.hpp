#pragma once

#include <optional>

/// Traversability of the ground under a wheel (thesis 3.5).
namespace talus::terramech {

/// What a mission may do on a piece of ground, best first; Unknown is none of the three.
enum class Category { Safe, Marginal, Dangerous, Unknown };

/// "safe", "marginal", "dangerous" or "unknown".
const char* name(Category category);

/// How a wheel stands at the reference slip.
struct WheelCondition {
  double drawbar_pull_over_load = 0.0;  ///< DP/W [-]
  double sinkage_over_radius = 0.0;     ///< z/r [-]
  std::optional<double> torque_over_load_radius =
      {};                           ///< T/(rW) [-]; none: the torque criterion is not applied
  std::optional<double> slip = {};  ///< driven at, [-1, 1]; none: the steering limit is not applied
};

/// Where the categories meet. A criterion whose limits are absent is not applied.
struct CategoryThresholds {
  double dp_low = 0.0;                     ///< DP/W below this is dangerous
  double dp_high = 0.0;                    ///< DP/W above this is safe; between, marginal
  double z_threshold = 0.5;                ///< z/r from here on costs a rank
  double z_critical = 0.75;                ///< z/r above this is dangerous
  std::optional<double> t_threshold = {};  ///< T/(rW) from here on costs a rank
  std::optional<double> t_critical = {};   ///< T/(rW) above this is dangerous
  /// Slip above this is dangerous: the wheel cannot be steered (ours).
  std::optional<double> steering_slip = {};
};

/// Slopes that set the drawbar pull thresholds.
struct MissionSlope {
  double slope_rad = 0.0;   ///< steepest slope that the mission must climb, [0, pi/2)
  double margin_rad = 0.0;  ///< uncertainty of the slope, plus or minus, >= 0
};

/// dp_low = tan(slope - margin), dp_high = tan(slope + margin) (thesis 3.5: 15 deg +- 5 deg gives tan 10 deg,
/// tan 20 deg); the other limits keep their defaults. Throws std::invalid_argument when slope + margin leaves
/// [0, pi/2).
CategoryThresholds thresholds(const MissionSlope& mission);

/// Throws std::invalid_argument naming the pair of limits that is out of order or not finite.
void validate(const CategoryThresholds& thresholds);

/// The rule of thesis 3.5, with its strict inequalities read literally: DP/W < dp_low dangerous, > dp_high
/// safe, else marginal; z > critical dangerous, z < threshold keeps the rank, else one rank down; torque
/// likewise; ranks lost to sinkage and to torque add up (the thesis leaves that case open). Unknown when a
/// given number is NaN.
Category categorise(const WheelCondition& condition, const CategoryThresholds& thresholds);

}  // namespace talus::terramech
