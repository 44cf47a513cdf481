#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

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

namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "output";

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError({path.string(), reason, "name another file, or pass --force"});
}

bool isOutput(const CLI::Option& option) {
  try {
    return const_cast<CLI::Option&>(option).get_validator(kMark) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

// Returns true for two names of one existing file, or two spellings of one path that does not exist yet.
bool same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error) && !error;
}

bool isJournal(const fs::path& path) {
  std::array<char, 15> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  return std::string_view(start.data(), start.size()) == "SQLite format 3";
}

// Suffixes of SQLite's files beside a database. Committed data that are not yet in the database exist only
// there.
constexpr std::array<std::string_view, 3> kBesideJournal{"-wal", "-shm", "-journal"};

// Target of a chain of symbolic links, also if the last target does not exist.
fs::path followed(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int link = 0; link < kMostLinks && fs::is_symlink(path, error); ++link)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

// The journal of which `path` is one of SQLite's side files; empty if `path` is no such file.
fs::path journalBehind(const fs::path& path) {
  const std::string name = followed(path).string();
  for (const std::string_view end : kBesideJournal)
    if (name.ends_with(end)) {
      const fs::path journal = name.substr(0, name.size() - end.size());
      if (std::error_code error; fs::is_regular_file(journal, error) && isJournal(journal)) return journal;
    }
  return {};
}

// File name endings of the formats that Talus writes; endings in one row denote the same format.
using Names = std::vector<std::string_view>;
const std::array<Names, 14> kFormats{{{".tif", ".tiff"},
                                      {".asc"},
                                      {".png"},
                                      {".jpg", ".jpeg"},
                                      {".svg"},
                                      {".html", ".htm"},
                                      {".geojson", ".json"},
                                      {".gpkg"},
                                      {".gpx"},
                                      {".kml"},
                                      {".csv"},
                                      {".yaml", ".yml"},
                                      {".ot"},
                                      {".bt"}}};

// Endings of formats that Talus never writes.
const Names kForeign{".db",   ".sqlite", ".sqlite3", ".shp", ".kmz", ".xml", ".vrt",     ".img", ".lbl",
                     ".nc",   ".h5",     ".hdf5",    ".mat", ".npy", ".npz", ".parquet", ".las", ".laz",
                     ".ply",  ".pcd",    ".obj",     ".stl", ".bag", ".pdf", ".ps",      ".eps", ".gif",
                     ".bmp",  ".webp",   ".pgm",     ".ppm", ".pnm", ".jp2", ".zip",     ".gz",  ".tgz",
                     ".bz2",  ".xz",     ".zst",     ".7z",  ".tar", ".xls", ".xlsx",    ".ods", ".doc",
                     ".docx", ".odt",    ".tex",     ".md",  ".c",   ".h",   ".cpp",     ".hpp", ".py",
                     ".js",   ".so",     ".a",       ".o",   ".exe", ".deb"};

const Names* formatOf(const std::string& name) {
  const std::string extension = maps::lower(fs::path(name).extension().string());
  for (const Names& names : kFormats)
    if (std::find(names.begin(), names.end(), extension) != names.end()) return &names;
  return std::find(kForeign.begin(), kForeign.end(), extension) != kForeign.end() ? &kForeign : nullptr;
}

bool leavesItsFolder(const fs::path& link) {
  std::error_code error;
  const fs::path folder = link.has_parent_path() ? link.parent_path() : fs::path(".");
  return !fs::exists(link, error) || fs::canonical(link, error).parent_path() != fs::canonical(folder, error);
}

}  // namespace

CLI::Option* addOutput(CLI::App& command, const std::string& name, std::string& path) {
  return addOption(command, name, path)
      ->check(CLI::Validator([](std::string&) { return std::string(); }, "", kMark));
}

void checkOutput(const fs::path& path, const std::vector<std::string>& inputs) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return;  // reported by OutputFile
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse(path, "is a device, a FIFO or a socket");
  if (fs::is_symlink(path, error) && leavesItsFolder(path)) refuse(path, "is a link to another folder");
  for (const std::string& input : inputs)
    if (!input.empty() && same(path, input)) refuse(path, "is also an input or another output of this call");
  if (fs::is_regular_file(status))
    for (const std::string& input : inputs)
      if (const std::string file = input.substr(input.find('=') + 1); fs::is_regular_file(file, error))
        for (const InputFile& part : maps::filesOpenedWith(file))
          if (same(path, part.path)) refuse(path, "is a part of the input " + file);
  if (fs::is_regular_file(status) && isJournal(path)) refuse(path, "is an SQLite file, as a journal is");
  if (const fs::path journal = journalBehind(path); !journal.empty())
    refuse(path, "is a part of the journal " + journal.string());
}

void checkBesideJournal(const fs::path& path, const fs::path& journal) {
  if (path.empty() || journal.empty()) return;
  const auto refuseIf = [&](const fs::path& taken, const std::string& reason) {
    if (same(followed(path), taken)) throw InputError({path.string(), reason, "name another file"});
  };
  const fs::path file = followed(journal);
  refuseIf(file, "is the journal of this call");
  for (const std::string_view end : kBesideJournal)
    refuseIf(file.string() + std::string(end), "is a part of the journal " + journal.string());
}

// Readers of the file would take the format from the name, for example of a GeoTIFF named .asc.
void checkFormat(const fs::path& path, const std::string& written) {
  const Names* named = formatOf(path.string());
  if (named == nullptr) return;
  std::vector<std::string> endings;
  std::istringstream choices(written);
  for (std::string choice; std::getline(choices, choice, '|');) {
    const Names* format = formatOf(choice);
    if (format == named) return;
    if (format != nullptr) endings.emplace_back(format->front());
  }
  if (endings.empty()) return;
  // Removes all known endings: OUT.geojson.gz becomes OUT.
  fs::path stem = path.stem();
  while (formatOf(stem.string()) != nullptr) stem = stem.stem();
  throw InputError({path.string(),
                    fmt::format("is named {}, but a {} file is written", path.extension().string(),
                                fmt::join(endings, " or ")),
                    "name it " + stem.string() + endings.front() + ", or pass --force"});
}

void checkOutputs(const CLI::App& command, bool force) {
  const auto options = command.get_options();
  for (const CLI::Option* output : options) {
    if (output->empty() || !isOutput(*output)) continue;
    const std::string path = output->results().front();
    std::vector<std::string> others;
    for (const CLI::Option* other : options)
      if (other != output && !other->empty())
        for (const std::string& word : other->results()) others.push_back(word);
    if (!force) {
      checkOutput(path, others);
      checkFormat(path, output->get_type_name());
    }
    const OutputFile can_be_written(path);
  }
}

}  // namespace talus::cli
