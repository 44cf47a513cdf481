#pragma once

#include <cstdint>
#include <functional>

namespace talus::planner {

/// Suppresses OMPL's log output while at least one object exists in any thread; then restores the host's
/// handler.
class QuietOmpl {
 public:
  QuietOmpl();
  ~QuietOmpl();
  QuietOmpl(const QuietOmpl&) = delete;
  QuietOmpl& operator=(const QuietOmpl&) = delete;
};

/// Runs `make` with OMPL's process-wide seed generator set to `seed`, exclusive of other callers of this
/// function. Objects created by `make` get the same random numbers regardless of previous runs.
void withOmplSeed(std::uint64_t seed, const std::function<void()>& make);

}  // namespace talus::planner
