#pragma once

namespace talus::terramech {

/// A rigid wheel; the grousers' tips lie at radius_m + grouser_height_m.
struct Wheel {
  double radius_m = 0.1;          ///< r in [1e-4, 10]
  double width_m = 0.1;           ///< b in [1e-4, 10]
  double grouser_height_m = 0.0;  ///< h in [0, 1], 0 for a smooth wheel
  int grouser_count = 0;          ///< 0 to 1000
};

/// Throws std::invalid_argument naming field, value and bound when a field leaves its range.
void validate(const Wheel& wheel);

}  // namespace talus::terramech
