#pragma once

#include <limits>
#include <numbers>

namespace talus {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< one degree in radians
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace talus
