#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

#include <talus/cli/app/status_line.hpp>

namespace talus::cli {

/// Converts the first SIGINT or SIGTERM to a stop request. Terminates the process if the work does not end
/// within 0.4 s of CPU time or 3 s of wall time, or uses no CPU time for 0.3 s (blocked, for example on a
/// FIFO), unless answered() is set. A second signal always terminates the process. Unfinished files are
/// removed. The object must be created before any other thread, so that all threads inherit the blocked
/// signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Returns the token through which work receives the stop request.
  std::stop_token token() const noexcept { return source_.get_token(); }
  bool requested() const noexcept { return source_.stop_requested(); }
  /// Returns the exit code of the received signal: 130 for SIGINT, 143 for SIGTERM.
  int code() const noexcept { return code_; }
  /// Returns the flag that work sets if it ends by itself after the stop request, such as planners, which
  /// return their best route.
  std::atomic<bool>& answered() noexcept { return answered_; }
  /// Returns the line that the listener thread draws until the first signal.
  StatusLine& status() noexcept { return status_; }

 private:
  void listen();
  void watch();

  sigset_t signals_{};
  std::stop_source source_;
  std::atomic<int> code_ = 130;
  std::atomic<bool> answered_ = false;
  std::atomic<bool> closing_ = false;
  StatusLine status_;
  std::thread listener_;
};

}  // namespace talus::cli
