#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace talus::cli {

/// Turns the first SIGINT or SIGTERM into a stop request; a second one ends the process at once with 130.
/// To be made before any other thread, so that all of them leave the signals to its own.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const noexcept { return source_.get_token(); }
  bool requested() const noexcept { return source_.stop_requested(); }

 private:
  void listen();

  sigset_t signals_{};
  std::stop_source source_;
  std::atomic<bool> closing_ = false;
  std::thread listener_;
};

}  // namespace talus::cli
