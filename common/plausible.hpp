#pragma once

#include <cmath>
#include <string_view>

namespace talus {

/// Condition that plausible() checks, as text for error messages.
inline constexpr const char* kPlausible = "must be 0 or between 1e-15 and 1e15 in magnitude";

/// Returns true if a number is 0 or satisfies 1e-15 <= |value| <= 1e15, and false for NaN and infinity.
/// Products and quotients of such numbers are in the range of a double. Every file reader first checks
/// plausible(), then the range of the field.
inline bool plausible(double value) noexcept {
  return value == 0.0 || (std::abs(value) >= 1e-15 && std::abs(value) <= 1e15);
}

/// Returns true if an integer is written in plain decimal. Returns false for a leading 0 or 0x, because other
/// programs read 010 as octal 8 and 0x10 as hexadecimal 16.
inline bool isDecimal(std::string_view word) noexcept {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  if (word.size() < 2 || word[0] != '0') return true;
  const bool hexadecimal = word[1] == 'x' || word[1] == 'X';
  return !hexadecimal && word.find_first_not_of("0123456789") != word.npos;
}

}  // namespace talus
