#pragma once

#include <array>

namespace talus::planner {

/// Eight values; loops over them have a fixed length, so that the compiler makes vectors of them.
using Lanes = std::array<float, 8>;

/// Returns the lower of two values, and the lowest of eight. Unlike std::min, the result may be a copy.
inline float less(float a, float b) noexcept {
  return a < b ? a : b;
}
inline float leastOf(const Lanes& of) noexcept {
  return less(less(less(of[0], of[4]), less(of[1], of[5])), less(less(of[2], of[6]), less(of[3], of[7])));
}

}  // namespace talus::planner
