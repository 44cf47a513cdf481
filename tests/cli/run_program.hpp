#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus::cli {

/// What a run of the program left behind.
struct Ran {
  int code = -1;  ///< exit code; 128 + signal where a signal ended it
  std::string out;
  std::string err;
};

/// Runs the built program with the words as its arguments, in a folder of the caller's; with an interrupt
/// (SIGINT) after so many seconds, 0 for none.
Ran runTalus(const std::vector<std::string>& words, const std::filesystem::path& folder = ".",
             double interrupt_s = 0.0);

/// A fresh folder, gone with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const noexcept { return path_; }

  /// Writes a file into the folder and returns its path.
  std::string write(const std::string& name, const std::string& content) const;

  /// Names of what lies in the folder, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// Content of a file; empty where it does not exist.
std::string fileContent(const std::filesystem::path& path);

}  // namespace talus::cli
