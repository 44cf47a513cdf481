#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talus {

/// A file that is replaced atomically: the content is written to a temporary file in the same folder, and the
/// temporary file is synchronised to the disk and renamed to the final path. A symbolic link stays a link,
/// and its target is replaced. A device or a FIFO receives the bytes by copying. The constructor removes
/// temporary files of the same name that terminated processes left.
class OutputFile {
 public:
  /// Throws InputError if the folder does not exist or is not writable, or if the path is a directory. The
  /// check precedes the computation, so that a long run does not fail at its end.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Path to write the content to; has the extension of the final path.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes `content` to the temporary file and synchronises it to the disk. Throws InputError on failure.
  void write(std::string_view content);

  /// Synchronises a temporary file that other code wrote to the disk. A power failure after commit() then
  /// leaves a complete file, and none of several files is moved before all are on the disk. Throws InputError
  /// on failure.
  void sync() const;

  /// Moves the temporary file to the final path. Throws InputError on failure and leaves the previous file
  /// unchanged.
  void commit();

  /// Throws InputError with the message "cannot be written: `reason`".
  [[noreturn]] void fail(const std::string& reason) const;

  /// Throws as fail(), with the system's reason if the file cannot grow. For libraries whose messages lack
  /// that reason.
  [[noreturn]] void failToGrow(const std::string& reason) const;

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool in_place_ = false;  // true if the path is a device or a FIFO
};

/// Writes `content` to a file through OutputFile. Throws InputError if the file cannot be written, for
/// example on a full disk.
void writeFile(const std::filesystem::path& path, std::string_view content);

/// Removes the temporary files of this process that were not committed. Called before the process ends by a
/// signal; returns without action if another thread has locked the list of files.
void removeUnfinishedFiles() noexcept;

}  // namespace talus
