#pragma once

#include <cmath>

namespace talus {

/// What a number handed in by a file or a call must be, whatever it means; for messages.
inline constexpr const char* kPlausible = "must be 0 or between 1e-15 and 1e15 in magnitude";

/// Whether a number can be a quantity in any unit that Talus reads: 0, or 1e-15 <= |value| <= 1e15. No NaN, no infinity,
/// and nothing whose products and quotients leave the range of a double. Every reader asks this first, then for the
/// range of its own field.
inline bool plausible(double value) noexcept {
  return value == 0.0 || (std::abs(value) >= 1e-15 && std::abs(value) <= 1e15);
}

}  // namespace talus
