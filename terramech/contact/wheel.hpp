#pragma once

namespace talus::terramech {

/// A rigid wheel; the grousers' tips lie at radius_m + grouser_height_m.
struct Wheel {
  double radius_m = 0.1;          ///< r in [1e-4, 10]
  double width_m = 0.1;           ///< b in [1e-4, 10]
  double grouser_height_m = 0.0;  ///< h in [0, 1], 0 for a smooth wheel
  int grouser_count = 0;          ///< 0 to 1000
  /// Share in [0, 5] of Bekker's shear on the lugs' side faces that the wheel gets, shearGain(); 0: as a smooth wheel [-].
  double lug_thrust = 0.0;
};

/// Lugs of a rover whose file states none of its own: 1 as bekker_1969; standard deviation 0.5 (ours).
inline constexpr double kLugThrust = 1.0;

/// What lugs multiply the shear strength along the rim by, 1 + lug_thrust 0.64 (h/b) atan(b/h) (bekker_1969, number unverified) [-]: the soil shears along the sides of what the lugs hold, too.
double shearGain(const Wheel& wheel) noexcept;

/// Throws std::invalid_argument naming field, value and bound when a field leaves its range.
void validate(const Wheel& wheel);

}  // namespace talus::terramech
