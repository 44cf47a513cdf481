#pragma once

#include <cstdint>
#include <string>

namespace talus {

/// Sets the memory that the process may use [bytes]. 0 selects the default: half of the memory that was
/// available at the first call of memoryBudget().
void setMemoryBudget(std::uint64_t bytes) noexcept;

/// The current memory budget [bytes]; infinity if no budget is set and the system does not report its
/// available memory.
double memoryBudget();

/// Checks `bytes` against the memory budget; call before allocating a size that a file or an argument states.
/// Throws InputError with `where` and the remedy if the resident memory of the process plus `bytes` exceeds
/// the budget. Requests below 1 MB always pass.
void requireMemory(double bytes, const std::string& where);

}  // namespace talus
