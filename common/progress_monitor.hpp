#pragma once

#include <functional>
#include <stop_token>

namespace talus {

/// Progress callback and stop token of a long computation. Copyable; both members may be empty.
struct ProgressMonitor {
  /// Callback that the computation calls repeatedly, from one thread, with the completed fraction [-], 0 to
  /// 1.
  std::function<void(double)> progress;
  std::stop_token stop;  ///< stop token; after a stop request the computation ends early, at its next check

  /// Calls `progress` with the completed fraction [-], 0 to 1, if the callback is not empty.
  void report(double fraction) const {
    if (progress) progress(fraction);
  }

  /// Returns true if a stop was requested.
  bool stopped() const noexcept { return stop.stop_requested(); }
};

}  // namespace talus
