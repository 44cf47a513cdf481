#pragma once

#include <cstdint>
#include <string>

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

}  // namespace talus
