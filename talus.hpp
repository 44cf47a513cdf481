#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

/// The few words that every room shares: how bad input is reported, how long work is watched and stopped, and
/// the unit of angle that people read.
namespace talus {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< one degree [rad]

/// A file or a value handed in by the user cannot be used; what() is one line: what, where, remedy.
class InputError : public std::runtime_error {
 public:
  /// The parts of the line. `where` is a path with a line, band or cell; `remedy` is what to do about it.
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

/// The fewest edits that make one word the other: insert, delete or replace a letter, swap two neighbours
/// (optimal string alignment).
inline std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      d[i][j] = i + j;
      if (i == 0 || j == 0) continue;
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// The known name that a mistyped word most likely means: fewest edits; empty where none is within a third of
/// the word's length (two edits for short words).
inline std::string nearestName(std::string_view word, const std::vector<std::string>& known) {
  std::string nearest;
  if (word.size() > 100) return nearest;  // no name is so long
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known)
    if (const std::size_t edits = editDistance(word, name); edits < fewest) {
      fewest = edits;
      nearest = name;
    }
  return nearest;
}

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
