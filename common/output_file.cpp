#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <talus/common/input_error.hpp>
#include <talus/common/output_file.hpp>

namespace talus {
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
    refuse(path, "cannot write into " + folder.string() + ": " + std::strerror(errno),
           "check its permissions, or name another folder");
}

bool isGone(std::string_view process) noexcept {
  pid_t number = 0;
  const char* end = process.data() + process.size();
  return std::from_chars(process.data(), end, number).ec == std::errc{} && number > 0 &&
         ::kill(number, 0) != 0 && errno == ESRCH;
}

// Removes temporary files of `path` whose process no longer exists.
void clearLeftovers(const fs::path& path) {
  const std::string stem = "." + path.stem().string() + ".";
  std::error_code ignored;
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(stem) && entry.path().extension() == path.extension() &&
        isGone(std::string_view(name).substr(stem.size())))
      fs::remove(entry.path(), ignored);
  }
}

// Path in `folder` that is unique among processes and calls: .STEM.PID-COUNT.EXTENSION.
fs::path besideName(const fs::path& folder, const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  return folder / ("." + path.stem().string() + "." + std::to_string(::getpid()) + "-" +
                   std::to_string(count++) + path.extension().string());
}

// Uncommitted temporary files of this process, for removeUnfinishedFiles().
struct Unfinished {
  std::mutex mutex;
  std::set<fs::path> paths;
};

Unfinished& unfinished() {
  static Unfinished all;
  return all;
}

/// A file descriptor that is closed by its destructor.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int operator*() const noexcept { return number_; }

 private:
  int number_;
};

// Copies the bytes of `from` to `to`. Returns false with errno set on failure.
bool copied(const fs::path& from, const fs::path& to) {
  // O_NONBLOCK makes the open of a FIFO without a reader fail at once instead of blocking.
  const Descriptor out(to, O_WRONLY | O_NONBLOCK);
  if (*out < 0) return false;
  ::fcntl(*out, F_SETFL, 0);
  std::ifstream in(from, std::ios::binary);
  std::array<char, 65536> piece{};
  while (in.read(piece.data(), piece.size()), in.gcount() > 0)
    for (std::string_view left(piece.data(), static_cast<std::size_t>(in.gcount())); !left.empty();) {
      const ssize_t written = ::write(*out, left.data(), left.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      left.remove_prefix(static_cast<std::size_t>(written));
    }
  return true;
}

}  // namespace

OutputFile::OutputFile(const fs::path& path) : path_(path) {
  if (path.empty() || path.filename().empty()) refuse(path, "is not a file name", "name a file to write");
  std::error_code error;
  if (fs::is_symlink(path, error) && fs::exists(path, error)) path_ = fs::canonical(path, error);
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::none)
    refuse(path, "cannot be written: " + error.message(), "name a file to write");
  if (fs::is_directory(status)) refuse(path, "is a directory", "name a file to write");
  in_place_ = fs::exists(status) && !fs::is_regular_file(status);
  if (!in_place_) {
    checkFolder(path_);
    clearLeftovers(path_);
  }
  temporary_ = besideName(in_place_ ? fs::temp_directory_path() : path_.parent_path(), path_);
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.insert(temporary_);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.erase(temporary_);
}

void OutputFile::commit() {
  if (in_place_) {
    if (!copied(temporary_, path_)) fail(std::strerror(errno));
    return;
  }
  sync();
  std::error_code error;
  const fs::file_status before = fs::status(path_, error);
  if (fs::exists(before)) fs::permissions(temporary_, before.permissions(), error);
  fs::rename(temporary_, path_, error);
  if (error) fail(error.message());
}

void OutputFile::write(std::string_view content) {
  std::ofstream stream(temporary_, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) fail(std::strerror(errno));
  sync();
}

void OutputFile::sync() const {
  const Descriptor file(temporary_, O_RDONLY);
  if (*file < 0 || ::fsync(*file) != 0) fail(std::strerror(errno));
}

void OutputFile::fail(const std::string& reason) const {
  refuse(path_, "cannot be written: " + reason, "check the folder, its permissions and free space");
}

void OutputFile::failToGrow(const std::string& reason) const {
  const std::string block(65536, '\0');
  const Descriptor file(temporary_, O_WRONLY | O_APPEND);
  // On a full disk, the first write may still succeed in part; a second write is therefore tested.
  const bool grows = *file < 0 || (::write(*file, block.data(), block.size()) >= 0 &&
                                   ::write(*file, block.data(), block.size()) >= 0);
  fail(grows ? reason : std::strerror(errno));
}

void writeFile(const fs::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

void removeUnfinishedFiles() noexcept {
  Unfinished& all = unfinished();
  const std::unique_lock lock(all.mutex, std::try_to_lock);
  if (!lock.owns_lock()) return;
  for (const fs::path& path : all.paths) ::unlink(path.c_str());
}

}  // namespace talus
