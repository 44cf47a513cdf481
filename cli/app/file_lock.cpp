#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <talus/cli/app/file_lock.hpp>
#include <talus/common/input_error.hpp>

namespace talus::cli {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw InputError({path.string(), std::string("cannot be locked: ") + std::strerror(errno), ""});
}

using Identity = std::pair<dev_t, ino_t>;

Identity identityOf(const struct stat& status) noexcept {
  return {status.st_dev, status.st_ino};
}

}  // namespace

FileLock::FileLock(const std::vector<std::filesystem::path>& paths, const std::stop_token& stop) {
  using namespace std::chrono_literals;
  // Locks all files or none: a process that locks one file while it waits for another could deadlock.
  while (!tryAll(paths)) {
    if (stop.stop_requested()) throw std::runtime_error("cancelled");
    std::this_thread::sleep_for(20ms);
  }
}

FileLock::~FileLock() {
  release();
}

bool FileLock::tryAll(const std::vector<std::filesystem::path>& paths) {
  std::set<Identity> seen;
  for (const auto& path : paths) {
    struct stat named {
    }, opened{};
    if (::stat(path.c_str(), &named) != 0 || !S_ISREG(named.st_mode)) continue;
    if (!seen.insert(identityOf(named)).second) continue;
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) refuse(path);
    held_.push_back(file);
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) refuse(path);
      release();
      return false;
    }
    // The previous owner of the lock may have replaced the file.
    if (::fstat(file, &opened) != 0 || ::stat(path.c_str(), &named) != 0 ||
        identityOf(opened) != identityOf(named)) {
      release();
      return false;
    }
  }
  return true;
}

void FileLock::release() noexcept {
  for (const int file : held_) ::close(file);
  held_.clear();
}

}  // namespace talus::cli
