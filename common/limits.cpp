#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <limits>

#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>

namespace talus {

namespace {

std::atomic<std::uint64_t> budget_bytes = 0;

// Half of MemAvailable of /proc/meminfo [bytes]. Infinite without that line, so that no request is refused.
double halfOfTheFree() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  for (double kilobytes = 0.0; file >> name >> kilobytes; file.ignore(100, '\n'))
    if (name == "MemAvailable:") return 512.0 * kilobytes;
  return std::numeric_limits<double>::infinity();
}

double inUse() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

void setMemoryBudget(std::uint64_t bytes) noexcept {
  budget_bytes = bytes;
}

double memoryBudget() {
  static const double half = halfOfTheFree();
  const std::uint64_t set = budget_bytes;
  return set > 0 ? static_cast<double>(set) : half;
}

void requireMemory(double bytes, const std::string& where) {
  const double budget = memoryBudget();
  // Requests below 1 MB skip the read of /proc/self/statm.
  constexpr double kSmall = 1e6;
  if (bytes < kSmall || bytes + inUse() <= budget) return;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "needs %.3g GB, more than the memory budget of %.3g GB leaves",
                bytes * 1e-9, budget * 1e-9);
  throw InputError({where, text.data(), "use a smaller file or part, or raise --max-memory"});
}

}  // namespace talus
