#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace talus::cli {

/// Returns the text of a phase of work with its completed fraction [-]: a bar with the time left, or the elapsed
/// time if the fraction is 0, which means unknown.
std::string progressText(std::string_view what, double fraction, double elapsed_s);

/// The last line of a terminal on stderr, which shows the present phase of work once the phase takes longer than half
/// a second. Thread-safe.
class StatusLine {
 public:
  /// Begins a phase, which hides those begun before until it ends. Returns the callback of its progress monitor;
  /// the phase ends with the fraction 1 or with the last copy of the callback, which must not outlive this object.
  std::function<void(double)> begin(std::string_view what);

  /// Draws the line. To be called several times a second.
  void tick();

  /// Erases the line until the next tick().
  void erase();

 private:
  struct Phase;

  std::mutex mutex_;
  std::vector<std::weak_ptr<Phase>> phases_;  // the last one that has not ended is shown
  bool drawn_ = false;
};

}  // namespace talus::cli
