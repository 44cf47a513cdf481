#pragma once

namespace talus::terramech {

/// Rigid wheel, smooth or with grousers (lugs). The grouser tips are at the radius radius_m +
/// grouser_height_m.
struct Wheel {
  double radius_m = 0.1;          ///< wheel radius r, in [1e-4, 10]
  double width_m = 0.1;           ///< wheel width b, in [1e-4, 10]
  double grouser_height_m = 0.0;  ///< grouser height h, in [0, 1]; 0 for a smooth wheel
  int grouser_count = 0;          ///< number of grousers, 0 to 1000
  /// Fraction of Bekker's shear force on the side faces of the lugs that shearGain() includes, in [0, 5] [-];
  /// 0 for a smooth wheel.
  double lug_thrust = 0.0;

  bool operator==(const Wheel&) const = default;
};

/// Default lug_thrust for a rover file that contains no value [-]: 1 (bekker_1969), with standard deviation
/// 0.5 (ours).
inline constexpr double kLugThrust = 1.0;

/// Returns the factor by which lugs increase the shear strength along the rim [-]: 1 + lug_thrust 0.64 (h/b)
/// atan(b/h) (bekker_1969, number unverified). The reason is that the soil between the lugs also shears along
/// its sides. Returns 1 without lugs.
double shearGain(const Wheel& wheel) noexcept;

/// Throws std::invalid_argument that names field, value and bound if a field is outside its range.
void validate(const Wheel& wheel);

}  // namespace talus::terramech
