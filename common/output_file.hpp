#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <string_view>

namespace talus {

/// File that is replaced whole or not at all. The content goes to a new temporary file in the same folder; the
/// temporary file is synchronised to the disk and renamed to the final path. Only the object that made a
/// temporary file removes it. If the path is a symbolic link, the link remains and its target is replaced. A
/// device, a FIFO (named pipe) or a name of an open descriptor (/dev/stdout) receives the bytes by copying.
class OutputFile {
 public:
  /// Throws InputError if the folder does not exist or is not writable, or if the path is a directory.
  /// Constructed before a long computation, the object thus prevents a failure at the end of the computation.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns the content: a binary stream that is written, read and positioned. A failed write throws
  /// InputError. The failure remains when the state of the stream is cleared: from then on each write,
  /// sync() and commit() throw.
  std::iostream& stream() noexcept { return stream_; }

  /// Writes `content` and synchronises it to the disk. Throws InputError on failure.
  void write(std::string_view content);

  /// Synchronises the content to the disk. A power failure after commit() then leaves a complete file. If
  /// several files are synchronised before the first commit(), none replaces its predecessor before all are
  /// on the disk. Throws InputError on failure.
  void sync();

  /// Moves the temporary file to the final path. On failure throws InputError and leaves the previous file
  /// unchanged.
  void commit();

 private:
  class Content;

  void copyToTarget();

  std::filesystem::path path_;
  std::filesystem::path temporary_{};
  std::unique_ptr<Content> content_{};
  std::iostream stream_{nullptr};
  bool in_place_ = false;  // true if the path is a device, a FIFO or a descriptor
};

/// Writes `content` to the file at `path` through OutputFile. Throws InputError if the file cannot be
/// written, for example on a full disk.
void writeFile(const std::filesystem::path& path, std::string_view content);

/// Removes the temporary files of this process that were not committed. A signal handler calls this function
/// before the process ends. The function returns without action if another thread has locked the list of
/// files.
void removeUnfinishedFiles() noexcept;

}  // namespace talus
