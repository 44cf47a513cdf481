#pragma once

#include <cmath>
#include <string_view>

namespace talus {

/// What a number handed in by a file or a call must be, whatever it means; for messages.
inline constexpr const char* kPlausible = "must be 0 or between 1e-15 and 1e15 in magnitude";

/// Whether a number can be a quantity in any unit that Talus reads: 0, or 1e-15 <= |value| <= 1e15. No NaN, no infinity,
/// and nothing whose products and quotients leave the range of a double. Every reader asks this first, then for the
/// range of its own field.
inline bool plausible(double value) noexcept {
  return value == 0.0 || (std::abs(value) >= 1e-15 && std::abs(value) <= 1e15);
}

/// Whether a whole number is written as a decimal one: 010 is 8 to many a reader, and 0x10 is 16.
inline bool isDecimal(std::string_view word) noexcept {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  if (word.size() < 2 || word[0] != '0') return true;
  const bool hexadecimal = word[1] == 'x' || word[1] == 'X';
  return !hexadecimal && word.find_first_not_of("0123456789") != word.npos;
}

}  // namespace talus
