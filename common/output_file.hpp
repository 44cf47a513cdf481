#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talus {

/// A file that appears whole or not at all: written beside its place, put onto the disk, then renamed onto it. A link
/// keeps pointing where it did; a device or a FIFO stays one and gets the bytes. What a killed process left beside
/// the place goes with the next file for it.
class OutputFile {
 public:
  /// Throws InputError when the folder is missing, or the place is a folder or cannot be written: at once, so that a
  /// long run does not fail at its end.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write; it has the extension of the final name.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes all of it there, onto the disk. Throws InputError when that fails.
  void write(std::string_view content);

  /// Puts onto the disk what was written there by other means, so that a power cut after commit() finds the whole file, and
  /// of several files none is put in its place before all are on the disk. Throws InputError when that fails.
  void sync() const;

  /// Puts what was written in its place. Throws InputError when that fails, and leaves what was there.
  void commit();

  /// Throws InputError: the file cannot be written, because of `reason`.
  [[noreturn]] void fail(const std::string& reason) const;

  /// The same for the writing of a library, whose message lacks the system's reason: that one where the file cannot grow.
  [[noreturn]] void failToGrow(const std::string& reason) const;

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool in_place_ = false;  // a device or a FIFO
};

/// Writes a whole file through OutputFile. Throws InputError when it cannot be written, also for a full disk.
void writeFile(const std::filesystem::path& path, std::string_view content);

/// Removes what this process has begun to write beside its files and not put in place: the last act before it ends by
/// a signal.
void removeUnfinishedFiles() noexcept;

}  // namespace talus
