#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/talus.hpp>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason, const std::string& remedy) {
  throw InputError({.where = path.string(), .reason = reason, .remedy = remedy});
}

void checkFolder(const fs::path& path) {
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::error_code error;
  if (!fs::is_directory(folder, error))
    refuse(path, "folder " + folder.string() + " does not exist", "make it first");
  if (::access(folder.c_str(), W_OK) != 0)
    refuse(path, fmt::format("cannot write into {}: {}", folder.string(), std::strerror(errno)), "");
}

bool isGone(std::string_view process) noexcept {
  pid_t number = 0;
  const char* end = process.data() + process.size();
  return std::from_chars(process.data(), end, number).ec == std::errc{} && number > 0 &&
         ::kill(number, 0) != 0 && errno == ESRCH;
}

/// What a killed process left beside a file.
void clearLeftovers(const fs::path& path) {
  const std::string stem = "." + path.stem().string() + ".";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(stem) && entry.path().extension() == path.extension() &&
        isGone(std::string_view(name).substr(stem.size())))
      fs::remove(entry.path(), ignored);
  }
}

/// A name in the same folder that no other run and no other file of this run uses.
fs::path besideName(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  return path.parent_path() /
         fmt::format(".{}.{}-{}{}", path.stem().string(), ::getpid(), count++, path.extension().string());
}

}  // namespace

OutputFile::OutputFile(const fs::path& path) : path_(path) {
  if (path.empty() || path.filename().empty()) refuse(path, "is not a file name", "name a file to write");
  std::error_code error;
  if (fs::is_symlink(path, error) && fs::exists(path, error)) path_ = fs::canonical(path, error);
  if (fs::is_directory(path_, error)) refuse(path, "is a directory", "name a file to write");
  if (fs::exists(path_, error) && !fs::is_regular_file(path_, error)) {
    temporary_ = path_;
    return;
  }
  checkFolder(path_);
  clearLeftovers(path_);
  temporary_ = besideName(path_);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (temporary_ != path_) fs::remove(temporary_, ignored);
}

void OutputFile::commit() {
  if (temporary_ == path_) return;
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) refuse(path_, "cannot be written: " + error.message(), "");
}

void writeFile(const fs::path& path, std::string_view content) {
  OutputFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) refuse(path, fmt::format("cannot be written: {}", std::strerror(errno)), "");
  file.commit();
}

}  // namespace talus::cli
