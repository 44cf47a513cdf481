#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace talus::terramech::test {

/// A file with the given content in the temporary folder, removed at the end of its scope.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content, const std::string& suffix = ".csv")
      : path_(std::filesystem::temp_directory_path() /
              ("talus_" + std::to_string(::getpid()) + "_" + std::to_string(count_++) + suffix)) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string path() const { return path_.string(); }

 private:
  static inline int count_ = 0;
  std::filesystem::path path_;
};

}  // namespace talus::terramech::test
