#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/label_names.hpp>
#include <talus/maps/raster/referenced_files.hpp>

namespace talus::maps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLevels = 8;

bool beginsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool endsWith(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

[[noreturn]] void refuseForeign(const std::string& path, const std::string& name) {
  throw InputError({path, "names '" + name.substr(0, 80) + "', which is no file of its own folder",
                    "put the files into one folder and name them without a path"});
}

// True if the extension is one of the auxiliary files that GDAL's drivers open beside a raster, world files
// (.tfw, .wld) included.
bool isAuxiliary(const std::string& name) {
  const std::string ending = lower(fs::path(name).extension().string());
  constexpr const char* kEndings[] = {".xml", ".aux", ".ovr", ".msk", ".prj", ".hdr",  ".wld", ".clr",
                                      ".stx", ".rep", ".sch", ".imd", ".rpb", ".pvl",  ".rpc", ".txt",
                                      ".lbl", ".img", ".tab", ".rrd", ".eph", ".pass", ".met", ".dbf",
                                      ".shx", ".cpg", ".dat", ".map", ".id",  ".mid"};
  const auto is = [&](const char* other) { return ending == other; };
  return std::any_of(std::begin(kEndings), std::end(kEndings), is) ||
         (ending.size() >= 2 && ending.size() <= 5 && (ending.back() == 'w' || endsWith(ending, "wx")));
}

// Checks a raster, the files that it names, and their auxiliary files.
class References {
 public:
  References(const std::string& path, bool allow_vrt) : allow_vrt_(allow_vrt) {
    std::error_code error;
    const fs::path folder = fs::path(path).parent_path();
    addFolder(folder);
    addFolder(fs::weakly_canonical(path, error).parent_path());
  }

  void check(const std::string& path) {
    std::error_code error;
    const fs::path file = fs::weakly_canonical(path, error);
    if (!seen_.insert(file).second) return;
    if (open_.size() >= kMostLevels)
      throw InputError({path, "is named through more than eight other files", "name the rasters directly"});
    open_.push_back(file);
    checkLabel(path);
    checkBeside(path);
    open_.pop_back();
  }

 private:
  struct Folder {
    fs::path path;  // with links resolved
    fs::path as_given;
    std::multimap<std::string, std::string> files;  // lower-case name -> name
  };

  bool isOpen(const fs::path& path) const {
    std::error_code error;
    return std::find(open_.begin(), open_.end(), fs::weakly_canonical(path, error)) != open_.end();
  }

  void addFolder(const fs::path& given) {
    std::error_code error;
    const fs::path path = fs::canonical(given.empty() ? fs::path(".") : given, error);
    const auto same = [&](const Folder& other) { return other.path == path; };
    if (error || std::any_of(folders_.begin(), folders_.end(), same)) return;
    Folder folder{path, given, {}};
    for (fs::directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
      const std::string name = at->path().filename().string();
      folder.files.emplace(lower(name), name);
    }
    folders_.push_back(std::move(folder));
  }

  // Checks a named file. The name must be a plain file name without characters that GDAL interprets further.
  void follow(const std::string& path, std::string name, bool virtual_raster = false) {
    name.erase(0, std::min(name.size(), name.find_first_not_of(" \t\r\n")));
    if (name.find_first_of("/\\:&") != name.npos || name.find("..") != name.npos) refuseForeign(path, name);
    name.erase(name.find_last_not_of(" \t\r\n") + 1);
    for (const Folder& folder : folders_) {
      const auto [begin, end] = folder.files.equal_range(lower(name));
      for (auto file = begin; file != end; ++file) {
        requireInside(path, folder, file->second);
        if (virtual_raster && isOpen(folder.path / file->second))
          throw InputError({path, "names itself by '" + name + "'", "name another raster"});
        check((folder.as_given / file->second).string());
      }
    }
  }

  void requireInside(const std::string& path, const Folder& folder, const std::string& name) const {
    std::error_code error;
    const fs::path file = folder.path / name;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status) || fs::is_directory(status)) return;
    const std::string shown = (folder.as_given / name).string();
    if (!fs::is_regular_file(status))
      throw InputError({shown, "is a device, a FIFO or a socket beside or named by '" + path + "'",
                        "remove it or give a file"});
    const fs::path target = fs::canonical(file, error).parent_path();
    const auto is = [&](const Folder& other) { return other.path == target; };
    if (error || std::none_of(folders_.begin(), folders_.end(), is))
      throw InputError(
          {shown, "is a link that leads out of the folder of '" + path + "'", "copy the file to its place"});
  }

  void checkLabel(const std::string& path) {
    const LabelNames label = labelNames(path);
    if (label.virtual_raster && !allow_vrt_)
      throw InputError(
          {path, "is a virtual raster, which names other files", "pass --allow-vrt if you trust it"});
    if (label.code) refuseForeign(path, "/vsi or code");
    for (const std::string& name : label.names) follow(path, name, label.virtual_raster);
  }

  // Checks the auxiliary files that GDAL opens because their names match the raster.
  void checkBeside(const std::string& path) {
    const fs::path itself = fs::path(path).filename();
    const std::string stem = lower(itself.stem().string());
    for (const Folder& folder : folders_) {
      std::vector<std::string> beside;
      for (auto at = folder.files.lower_bound(stem); at != folder.files.end() && beginsWith(at->first, stem);
           ++at) {
        const char next = at->first[std::min(stem.size(), at->first.size() - 1)];
        if ((next == '.' || next == '_') && at->second != itself && isAuxiliary(at->second))
          beside.push_back(at->second);
      }
      for (const std::string& name : beside) checkAuxiliary(path, folder, name);
    }
  }

  void checkAuxiliary(const std::string& path, const Folder& folder, const std::string& name) {
    requireInside(path, folder, name);
    const std::string file = (folder.as_given / name).string();
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    const std::string low = lower(name);
    if (endsWith(low, ".aux.xml"))
      for (const std::string& named : auxiliaryNames(file)) follow(file, named);
    if (endsWith(low, ".ovr") || endsWith(low, ".msk") || endsWith(low, ".aux")) check(file);
  }

  bool allow_vrt_;
  std::vector<Folder> folders_;
  std::set<fs::path> seen_;
  std::vector<fs::path> open_;
};

}  // namespace

void refuseForeignReferences(const std::string& path, bool allow_vrt) {
  References(path, allow_vrt).check(path);
}

}  // namespace talus::maps
