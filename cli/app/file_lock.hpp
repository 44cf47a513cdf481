#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

namespace talus::cli {

/// Locks files against other Talus processes that read, change and rewrite the same files; later processes
/// wait. Paths of files that do not exist are ignored. The lock is advisory: programs that do not request the
/// lock are not blocked.
class FileLock {
 public:
  /// Waits until all files are locked; the destructor releases the locks. Throws InputError if a file cannot
  /// be opened or locked, and std::runtime_error if a stop is requested.
  FileLock(const std::vector<std::filesystem::path>& paths, const std::stop_token& stop);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  bool tryAll(const std::vector<std::filesystem::path>& paths);
  void release() noexcept;

  std::vector<int> held_;
};

}  // namespace talus::cli
