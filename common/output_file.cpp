#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <system_error>

#include <ext/stdio_filebuf.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>

namespace talus {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason, const std::string& remedy) {
  throw InputError({.where = path.string(), .reason = reason, .remedy = remedy});
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

// Creates a file of a new name in the folder, with the permissions of a new file. Returns its descriptor, or
// -1 with errno set.
int create(const fs::path& folder, fs::path& name) {
  std::random_device random;
  const std::lock_guard lock(unfinished().mutex);
  for (;;) {
    name = folder / (".talus-" + std::to_string(random()));
    const int file = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) unfinished().paths.insert(name);
    if (file >= 0 || errno != EEXIST) return file;
  }
}

void discard(const fs::path& temporary) noexcept {
  const std::lock_guard lock(unfinished().mutex);
  if (unfinished().paths.erase(temporary) > 0) ::unlink(temporary.c_str());
}

// Number of this process' open descriptor that a name such as /dev/stdout denotes; -1 for another name.
int descriptorOf(const fs::path& path) {
  std::error_code error;
  for (const fs::path& name : {path, fs::read_symlink(path, error)}) {
    int number = -1;
    const std::string digits = name.filename().string();
    if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec == std::errc{} &&
        fs::equivalent(name.parent_path(), "/proc/self/fd", error))
      return number;
  }
  return -1;
}

}  // namespace

// Buffer of a descriptor that remembers the first failed write.
class OutputFile::Content : public __gnu_cxx::stdio_filebuf<char> {
 public:
  Content(fs::path path, int descriptor, std::ios::openmode mode)
      : stdio_filebuf(descriptor, mode | std::ios::binary), path_(std::move(path)) {}

  // Throws InputError if an operation failed, now or before; `success` is the result of this one.
  void require(bool success) {
    if (!success && error_ == 0) error_ = errno;
    if (error_ != 0)
      refuse(path_, std::string("cannot be written: ") + std::strerror(error_),
             "check the folder, its permissions and free space");
  }

 protected:
  int_type overflow(int_type c) override {
    require(true);
    const int_type written = stdio_filebuf::overflow(c);
    require(written != traits_type::eof());
    return written;
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    require(true);
    require(stdio_filebuf::xsputn(text, size) == size);
    return size;
  }

 private:
  fs::path path_;
  int error_ = 0;
};

OutputFile::OutputFile(const fs::path& path) : path_(path) {
  if (path.empty() || path.filename().empty()) refuse(path, "is not a file name", "name a file to write");
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::none)
    refuse(path, "cannot be written: " + error.message(), "name a file to write");
  if (fs::is_directory(status)) refuse(path, "is a directory", "name a file to write");
  in_place_ = fs::exists(status) && (!fs::is_regular_file(status) || descriptorOf(path) >= 0);
  if (!in_place_ && fs::is_symlink(path, error) && fs::exists(status)) path_ = fs::canonical(path, error);
  const fs::path beside = path_.has_parent_path() ? path_.parent_path() : ".";
  const fs::path folder = in_place_ ? fs::temp_directory_path() : beside;
  const int file = create(folder, temporary_);
  if (file < 0 && (errno == ENOENT || errno == ENOTDIR))
    refuse(path, "folder " + folder.string() + " does not exist", "make it first");
  if (file < 0)
    refuse(path, "cannot write into " + folder.string() + ": " + std::strerror(errno),
           "check its permissions, or name another folder");
  if (in_place_) discard(temporary_);  // the descriptor keeps the content
  content_ = std::make_unique<Content>(path_, file, std::ios::in | std::ios::out);
  stream_.rdbuf(content_.get());
  stream_.exceptions(std::ios::badbit | std::ios::failbit);
}

OutputFile::~OutputFile() {
  discard(temporary_);
}

void OutputFile::write(std::string_view content) {
  stream_.write(content.data(), static_cast<std::streamsize>(content.size()));
  sync();
}

void OutputFile::sync() {
  stream_.flush();
  content_->require(::fsync(content_->fd()) == 0);
}

void OutputFile::commit() {
  sync();
  if (in_place_) return copyToTarget();
  struct stat before {};
  if (::stat(path_.c_str(), &before) == 0) ::fchmod(content_->fd(), before.st_mode);
  content_->require(::rename(temporary_.c_str(), path_.c_str()) == 0);
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.erase(temporary_);
}

void OutputFile::copyToTarget() {
  // O_NONBLOCK makes the open of a FIFO without a reader fail at once instead of blocking.
  const int number = descriptorOf(path_);
  const int target = number >= 0 ? ::dup(number) : ::open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  content_->require(target >= 0);
  if (number < 0) ::fcntl(target, F_SETFL, 0);
  Content out(path_, target, std::ios::out);
  std::array<char, 65536> piece{};
  content_->pubseekpos(0);
  while (const auto size = content_->sgetn(piece.data(), piece.size())) out.sputn(piece.data(), size);
  out.pubsync();
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
