#pragma once

#include <functional>
#include <stop_token>

namespace talus {

/// How a caller follows long work and stops it. Copyable; both parts may be empty.
struct ProgressMonitor {
  std::function<void(double)>
      progress;          ///< called now and then with the fraction done, 0 to 1, from one thread
  std::stop_token stop;  ///< work ends early, at its next check, once a stop is requested

  /// Reports the fraction done [-], 0 to 1.
  void report(double fraction) const {
    if (progress) progress(fraction);
  }

  /// Whether a stop was requested.
  bool stopped() const noexcept { return stop.stop_requested(); }
};

}  // namespace talus
