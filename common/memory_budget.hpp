#pragma once

#include <cstdint>
#include <string>

namespace talus {

/// Sets how much memory the process may take, in bytes; 0: half of what the machine had free at the first question.
void setMemoryBudget(std::uint64_t bytes) noexcept;

/// The budget in force, in bytes; infinite where the system does not say what is free.
double memoryBudget();

/// Asked before a size that a file or a call states becomes memory. Throws InputError, with `where` and the remedy,
/// when what the process has and `bytes` more exceed the budget.
void requireMemory(double bytes, const std::string& where);

}  // namespace talus
