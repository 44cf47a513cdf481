#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// Resource limits of a child process, which is killed if it exceeds them.
struct ChildLimits {
  double seconds = std::numeric_limits<double>::infinity();     ///< wall time, > 0
  std::size_t bytes = std::numeric_limits<std::size_t>::max();  ///< size of the result
  std::uint64_t memory = 0;                                     ///< bytes beyond the parent's; 0: no limit
};

/// Result of a child process.
struct ChildAnswer {
  /// The work returned; a stop was requested; the time limit was exceeded; the result was too large; or the
  /// process ended without a result.
  enum class End { Answered, Stopped, TooLate, TooMuch, Died };
  End end = End::Died;
  std::string bytes;       ///< result of the work; empty unless Answered
  int signal = 0;          ///< signal that ended the process; 0: none
  int exit_code = 0;       ///< exit code if no signal ended the process
  double megabytes = 0.0;  ///< peak memory
};

/// Runs work in a child process and returns its result; crashes, aborts and endless loops are reported as
/// results. The child is killed if the parent is killed. Output of the child is redirected to standard error.
/// Must be called while the program has no other threads. An exception in the work gives the result Died.
/// Throws std::runtime_error if no process can be created.
ChildAnswer inChild(const std::function<std::string()>& work, const ChildLimits& limits,
                    const ProgressMonitor& watch = {});

}  // namespace talus::planner
