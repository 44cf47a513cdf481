#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// What work in a child process may take before it is ended.
struct ChildLimits {
  double seconds = std::numeric_limits<double>::infinity();     ///< of the clock, > 0
  std::size_t bytes = std::numeric_limits<std::size_t>::max();  ///< of its answer
  std::uint64_t memory = 0;                                     ///< bytes beyond what the parent has; 0: any
};

/// How work in a child process ended.
struct ChildAnswer {
  /// The work returned; a stop was requested; a limit was passed; or the process did not live to answer.
  enum class End { Answered, Stopped, TooLate, TooMuch, Died };
  End end = End::Died;
  std::string bytes;       ///< what the work returned; empty unless Answered
  int signal = 0;          ///< that a dead process was ended by, 0 where it was none
  int exit_code = 0;       ///< of a process that was ended by no signal
  double megabytes = 0.0;  ///< peak memory
};

/// Runs work in a child process and returns its answer: a crash, an abort or a run-away is a result. The child does not
/// outlive a program that is ended at once, and what it prints goes to standard error. Call it while the
/// program has no other threads. What the work throws counts as Died. Throws std::runtime_error when no
/// process can be made.
ChildAnswer inChild(const std::function<std::string()>& work, const ChildLimits& limits,
                    const ProgressMonitor& watch = {});

}  // namespace talus::planner
