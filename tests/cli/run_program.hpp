#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus::cli {

/// The words of a call after each other.
std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& more);

/// Exit code, standard output and standard error of a run of the program.
struct Ran {
  int code = -1;  ///< exit code; 128 + signal number if a signal ended the process
  std::string out;
  std::string err;
};

/// Runs the built program with the arguments in `words` in the given folder. Sends SIGINT after the given
/// time [s]; 0 means no signal.
Ran runTalus(const std::vector<std::string>& words, const std::filesystem::path& folder = ".",
             double interrupt_s = 0.0);

/// A new temporary folder, removed by the destructor.
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

  /// Sorted names of the files in the folder.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// Content of a file; empty if the file does not exist.
std::string fileContent(const std::filesystem::path& path);

}  // namespace talus::cli
