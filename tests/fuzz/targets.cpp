#include "targets.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <unistd.h>
#include <yaml-cpp/exceptions.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>

namespace talus::fuzz {

namespace {

namespace fs = std::filesystem;

// In memory where the machine has such a folder; gone with the process.
struct Folder {
  Folder() {
    std::string name = (fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().string()) +
                       "/talus-fuzz-XXXXXX";
    path = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path path;
};

}  // namespace

// Made anew: a library that is loaded keeps the file that it was.
std::string fileOf(const std::string& bytes, const std::string& ending) {
  static const Folder folder;
  const fs::path path = folder.path / ("input" + ending);
  for (const char* more : {"", "-wal", "-shm"}) fs::remove(path.string() + more);
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

void limitMemory() {
  setMemoryBudget(std::uint64_t{1} << 30U);
}

bool accepts(const Target& target, const std::string& bytes) {
  try {
    target.read(bytes);
    return true;
  } catch (const InputError&) {
  } catch (const std::invalid_argument&) {
  } catch (const std::domain_error&) {
  } catch (const nlohmann::json::exception&) {
  } catch (const YAML::Exception&) {
  }
  return false;
}

}  // namespace talus::fuzz
