#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

namespace talus::cli {

/// Holds files against other processes of Talus that read one, change it and put it back: they queue. Files that do
/// not exist are left out. Advisory: who does not ask is not kept away.
class FileLock {
 public:
  /// Waits for its turn. Throws InputError when a file cannot be opened or locked, std::runtime_error when stopped.
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
