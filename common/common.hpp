#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace talus {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< one degree in radians
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Error thrown if a file or value that the user supplies cannot be used. what() returns one line: "where:
/// reason; remedy".
class InputError : public std::runtime_error {
 public:
  /// The three parts of the message.
  struct Parts {
    std::string where;   ///< location of the fault: "site.tif, band 2" or "drive.csv:17" (line)
    std::string reason;  ///< the fault, for example "no CRS"
    std::string remedy;  ///< action for the user, for example "pass --resolution METRES"; may be empty
  };

  explicit InputError(Parts parts)
      : std::runtime_error(parts.where + ": " + parts.reason + (parts.remedy.empty() ? "" : "; ") +
                           parts.remedy),
        parts_(std::move(parts)) {}

  const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
};

/// The door of all input files.

/// A file that a call reads, or that belongs to such a file.
struct InputFile {
  std::string path{};       ///< path as the call, or the file to which it belongs, names it
  std::string role{};       ///< what the file states: "elevation", "mask", "rover", ...; empty: unknown
  std::uintmax_t size = 0;  ///< [bytes]
  std::string sha256{};     ///< SHA-256 of the content, hexadecimal; empty without nettle
  bool used = true;         ///< false: named by an option or beside a file, and read by nothing
};

/// Records the files that pass checkInput() in this thread while the object exists. Inside another record the
/// outer one records.
class InputRecord {
 public:
  InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;
  ~InputRecord();

 private:
  std::vector<InputFile> files_{};
};

/// Returns the manifest of this thread's record: each file once, in the order of reading, with size and SHA-256;
/// empty without a record.
std::vector<InputFile> filesRead();

/// Returns the SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty if the
/// file cannot be read, or in a build without nettle (the on-board core).
std::string sha256OfFile(const std::string& path);

/// Records a file, and compares it with the checksum in PATH.sha256 (format of sha256sum), if that file exists and
/// the build has nettle. Every reader of a file calls this function before it reads. @throws InputError if
/// the checksums differ
void checkInput(const std::string& path, const std::string& role = "", bool used = true);

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
