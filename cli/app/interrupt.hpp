#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace talus::cli {

/// Turns the first SIGINT or SIGTERM into a stop request. Work that does not end by itself within 0.4 s of the process's
/// CPU time or 3 s, or takes none for 0.3 s (it waits, as for a FIFO), and has not said that it answers, is ended; so is
/// all work by a second signal. Files that are not finished are removed. To be made before any other thread, so that all of them leave the signals to its own.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const noexcept { return source_.get_token(); }
  bool requested() const noexcept { return source_.stop_requested(); }
  /// Exit code of the signal that came: 130 or 143.
  int code() const noexcept { return code_; }
  /// To be set by work that answers the stop request by itself, as planners do with their best route.
  std::atomic<bool>& answered() noexcept { return answered_; }

 private:
  void listen();
  void watch();

  sigset_t signals_{};
  std::stop_source source_;
  std::atomic<int> code_ = 130;
  std::atomic<bool> answered_ = false;
  std::atomic<bool> closing_ = false;
  std::thread listener_;
};

}  // namespace talus::cli
