#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talus::cli {

/// A file that appears whole or not at all: written beside its place, then renamed onto it.
/// The folder is checked at once, so that a long run does not fail at its end.
class OutputFile {
 public:
  /// Throws InputError when the folder is missing, or the place is a folder or cannot be written.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write; it has the extension of the final name. A device such as /dev/stdout is written
  /// directly.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Puts what was written in its place. Throws InputError when that fails.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

/// Writes a whole file through OutputFile. Throws InputError when it cannot be written, also for a full disk.
void writeFile(const std::filesystem::path& path, std::string_view content);

}  // namespace talus::cli
