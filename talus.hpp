#pragma once

#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string>

/// The few words that every room shares: how bad input is reported, how long work is watched and stopped.
namespace talus {

/// A file or a value handed in by the user cannot be used; what() is one line: what, where, remedy.
class InputError : public std::runtime_error {
 public:
  /// The parts of the line. `where` is a path with a line, band or cell; `remedy` tells what to do about it.
  struct Parts {
    std::string where;   ///< "site.tif, band 2" or "drive.csv:17"
    std::string reason;  ///< "no CRS"
    std::string remedy;  ///< "pass --resolution METRES"; may be empty
  };

  explicit InputError(Parts parts) : std::runtime_error(line(parts)), parts_(std::move(parts)) {}

  const Parts& parts() const noexcept { return parts_; }

 private:
  static std::string line(const Parts& p) {
    return p.where + ": " + p.reason + (p.remedy.empty() ? "" : "; " + p.remedy);
  }

  Parts parts_;
};

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
