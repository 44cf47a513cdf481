#pragma once

#include <functional>
#include <stop_token>

namespace talus {

/// Progress callback and stop token of a long computation. Copyable; both members may be empty.
struct ProgressMonitor {
  std::function<void(double)>
      progress;          ///< called repeatedly with the fraction done [-], 0 to 1, from one thread
  std::stop_token stop;  ///< the computation ends early, at its next check, after a stop request

  /// Calls `progress` with the fraction done [-], 0 to 1.
  void report(double fraction) const {
    if (progress) progress(fraction);
  }

  /// True if a stop was requested.
  bool stopped() const noexcept { return stop.stop_requested(); }
};

}  // namespace talus
