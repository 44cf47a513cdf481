#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace talus {

/// Sets the memory budget, the memory that the process may use [bytes]. 0 selects the default: half of the
/// memory that was available at the first call of memoryBudget().
void setMemoryBudget(std::uint64_t bytes) noexcept;

/// Returns the memory budget [bytes]. Returns infinity if no budget was set and the system does not report
/// its available memory.
double memoryBudget();

/// Checks a planned allocation of `bytes` against the memory budget. A caller uses this check before an
/// allocation whose size comes from a file or an argument. Throws InputError with `where` (file or argument)
/// and a remedy if the resident memory of the process plus `bytes` exceeds the budget. Requests below 1 MB
/// always pass.
void requireMemory(double bytes, const std::string& where);

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
