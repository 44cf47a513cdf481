#pragma once

namespace talus::terramech {

/// Rigid wheel; the grouser tips are at radius_m + grouser_height_m.
struct Wheel {
  double radius_m = 0.1;          ///< r in [1e-4, 10]
  double width_m = 0.1;           ///< b in [1e-4, 10]
  double grouser_height_m = 0.0;  ///< h in [0, 1]; 0 for a smooth wheel
  int grouser_count = 0;          ///< 0 to 1000
  /// Fraction in [0, 5] of Bekker's shear force on the side faces of the lugs that acts in shearGain() [-];
  /// 0: smooth wheel.
  double lug_thrust = 0.0;
};

/// Default lug_thrust for a rover file without one [-]: 1 as bekker_1969; standard deviation 0.5 (ours).
inline constexpr double kLugThrust = 1.0;

/// Returns the factor of the lugs on the shear strength along the rim [-], 1 + lug_thrust 0.64 (h/b)
/// atan(b/h) (bekker_1969, number unverified): the soil between the lugs also shears along its sides. Returns
/// 1 without lugs.
double shearGain(const Wheel& wheel) noexcept;

/// Throws std::invalid_argument with field, value and bound if a field is outside its range.
void validate(const Wheel& wheel);

}  // namespace talus::terramech
