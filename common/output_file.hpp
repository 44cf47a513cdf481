#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talus {

/// File that is replaced atomically. The content is written to a temporary file in the same folder; the
/// temporary file is synchronised to the disk and renamed to the final path. If the path is a symbolic link,
/// the link remains and its target is replaced. A device or a FIFO (named pipe) receives the bytes by
/// copying.
class OutputFile {
 public:
  /// Throws InputError if the folder does not exist or is not writable, or if the path is a directory.
  /// Constructed before a long computation, the object thus prevents a failure at the end of the computation.
  /// The constructor also removes temporary files for the same path that terminated processes left.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns the path of the temporary file, to which the content is written. The extension is that of the
  /// final path.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes `content` to the temporary file and synchronises it to the disk. Throws InputError on failure.
  void write(std::string_view content);

  /// Synchronises to the disk a temporary file that other code wrote. A power failure after commit() then
  /// leaves a complete file. If several files are synchronised before the first commit(), none replaces its
  /// predecessor before all are on the disk. Throws InputError on failure.
  void sync() const;

  /// Moves the temporary file to the final path. On failure throws InputError and leaves the previous file
  /// unchanged.
  void commit();

  /// Throws InputError with the message "cannot be written: `reason`".
  [[noreturn]] void fail(const std::string& reason) const;

  /// Throws the exception of fail(), with the system's reason added if the file cannot grow. Used for
  /// libraries whose messages lack that reason.
  [[noreturn]] void failToGrow(const std::string& reason) const;

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool in_place_ = false;  // true if the path is a device or a FIFO
};

/// Writes `content` to the file at `path` through OutputFile. Throws InputError if the file cannot be
/// written, for example on a full disk.
void writeFile(const std::filesystem::path& path, std::string_view content);

/// Removes the temporary files of this process that were not committed. A signal handler calls this function
/// before the process ends. The function returns without action if another thread has locked the list of
/// files.
void removeUnfinishedFiles() noexcept;

}  // namespace talus
