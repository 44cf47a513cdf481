#pragma once

#include <cstdint>
#include <functional>

namespace talus::planner {

/// Guard that suppresses the log output of OMPL while at least one guard exists in any thread. The last guard
/// restores the log handler of the program.
class QuietOmpl {
 public:
  QuietOmpl();
  ~QuietOmpl();
  QuietOmpl(const QuietOmpl&) = delete;
  QuietOmpl& operator=(const QuietOmpl&) = delete;
};

/// Calls `make` with the process-wide seed generator of OMPL set to `seed`. Calls of this function exclude
/// each other. Objects that `make` creates get the same random numbers, regardless of previous runs.
void withOmplSeed(std::uint64_t seed, const std::function<void()>& make);

}  // namespace talus::planner
