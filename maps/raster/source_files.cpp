#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_handle.hpp>
#include <talus/maps/raster/source_files.hpp>

namespace talus::maps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLevels = 8;  // of virtual rasters that name each other

fs::path folderOf(const fs::path& file) {
  std::error_code error;
  return fs::canonical(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
}

struct Side {
  std::string_view ending, role;
};
// Files that belong to FILE.tif as FILE.tif.msk, and as FILE.prj.
constexpr Side kAppended[] = {{".msk", "mask"}, {".aux.xml", "auxiliary"}, {".ovr", "overviews"}};
constexpr Side kReplacing[] = {
    {".prj", "CRS"}, {".tfw", "place"}, {".wld", "place"}, {".hdr", "label"}, {".lbl", "label"}};

std::string roleOf(const std::string& file, bool is_virtual) {
  const std::string name = lower(file);
  for (const auto& sides : {std::span<const Side>(kAppended), std::span<const Side>(kReplacing)})
    for (const auto& [ending, role] : sides)
      if (name.ends_with(ending)) return std::string(role);
  return is_virtual ? "source" : "data";
}

bool isVirtual(GDALDataset& dataset) {
  return GDALGetDriverShortName(dataset.GetDriver()) == std::string_view("VRT");
}

// Checks the files of a dataset and of the sources of a virtual raster.
class Sources {
 public:
  explicit Sources(const std::string& path) : first_(path), given_(folderOf(path)) {
    std::error_code error;
    target_ = fs::weakly_canonical(path, error).parent_path();
  }

  void add(GDALDataset& dataset, const std::string& path) {
    if (open_.size() >= kMostLevels)
      throw InputError({path, "is named through more than eight other files", "name the rasters directly"});
    open_.push_back(path);
    const std::vector<InputFile> files = filesOf(dataset, path);
    for (const InputFile& file : files)
      if (file.path != path) take(file);
    if (std::ranges::count(files, "auxiliary", &InputFile::role) > 0) requireAgreement(dataset, path);
    if (isVirtual(dataset)) requirePlainNames(dataset, path);
    for (const InputFile& file : files)
      if (file.role == "source") addSource(file.path, path);
    open_.pop_back();
  }

 private:
  // Takes a file that lies in the folder of the raster.
  void take(const InputFile& file) {
    if (!file.used && (file.role == "mask" || file.role == "auxiliary"))
      throw InputError({file.path,
                        "belongs to the raster by its name, and GDAL does not use it, as when it is damaged",
                        "write it again, or remove it"});
    if (!file.used) return checkInput(file.path, file.role, false);
    std::error_code error;
    const fs::path folder = fs::canonical(file.path, error).parent_path();
    if (error || (folder != given_ && folder != target_))
      throw InputError({first_, "names '" + file.path.substr(0, 80) + "', which is no file of its own folder",
                        "put the files into one folder and name them without a path"});
    requireReadableFile(file.path, file.role);
    if (file.role == "auxiliary") requireXml(file.path);
  }

  // What the raster states alone, and what it states with its auxiliary file, must not differ.
  static void requireAgreement(GDALDataset& dataset, const std::string& path) {
    const CPLConfigOptionSetter alone("GDAL_PAM_ENABLED", "NO", false);
    const GdalErrors quiet;
    const Dataset own(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    const auto refuseIf = [&](bool differs, const char* what) {
      if (differs)
        throw InputError({path + ".aux.xml",
                          std::string("states another ") + what + " than the raster itself",
                          "remove it, or correct one of them with gdal_edit.py"});
    };
    if (!own) return;
    std::array<double, 6> a{}, b{};
    refuseIf(
        own->GetGeoTransform(a.data()) == CE_None && dataset.GetGeoTransform(b.data()) == CE_None && a != b,
        "place");
    const OGRSpatialReference *c = own->GetSpatialRef(), *d = dataset.GetSpatialRef();
    refuseIf(c != nullptr && d != nullptr && c->IsSame(d) == 0, "CRS");
    for (int i = 1; i <= std::min(own->GetRasterCount(), dataset.GetRasterCount()); ++i) {
      GDALRasterBand &band = *own->GetRasterBand(i), &with = *dataset.GetRasterBand(i);
      int stated = 0;
      const double nodata = band.GetNoDataValue(&stated), other = with.GetNoDataValue();
      refuseIf(stated != 0 && nodata != other && !(std::isnan(nodata) && std::isnan(other)), "no-data value");
      const double scale = band.GetScale(&stated);
      refuseIf(stated != 0 && scale != with.GetScale(), "scale");
      const double offset = band.GetOffset(&stated);
      refuseIf(stated != 0 && offset != with.GetOffset(), "offset");
      const std::string unit = band.GetUnitType();
      refuseIf(!unit.empty() && unit != with.GetUnitType(), "unit");
    }
  }

  static void requireXml(const std::string& file) {
    const GdalErrors errors;
    const CPLXMLTreeCloser tree(CPLParseXMLFile(file.c_str()));
    if (!tree) throw InputError({file, "is no XML: " + errors.last(), "write it again, or remove it"});
  }

  // Sources are compared with GDAL's list by their names alone; /vsi, subdatasets and pixel functions are not
  // in it.
  static void requirePlainNames(GDALDataset& dataset, const std::string& path) {
    char** xml = dataset.GetMetadata("xml:VRT");
    const CPLXMLTreeCloser tree(CPLParseXMLString(xml == nullptr ? "" : *xml));
    std::vector<const CPLXMLNode*> open{tree.get()};
    while (!open.empty()) {
      const CPLXMLNode* node = open.back();
      open.pop_back();
      if (node == nullptr) continue;
      open.push_back(node->psNext);
      open.push_back(node->psChild);
      if (node->eType != CXT_Element) continue;
      const std::string element = lower(node->pszValue);
      if (element == "pixelfunctiontype")
        throw InputError(
            {path, "contains code (PixelFunctionType)", "compute the raster with gdal_translate"});
      const bool names_file = element == "sourcefilename" || element == "sourcedataset";
      const fs::path name = names_file ? CPLGetXMLValue(node, nullptr, "") : "";
      if (name.string().find(':') != std::string::npos || name.string().starts_with("/vsi"))
        throw InputError({path,
                          "names '" + name.string().substr(0, 80) + "', which is no file of its own folder",
                          "put the files into one folder and name them without a path"});
    }
  }

  void addSource(const std::string& file, const std::string& path) {
    std::error_code error;
    const auto same = [&](const std::string& other) { return fs::equivalent(file, other, error); };
    if (std::ranges::any_of(open_, same))
      throw InputError({path, "names itself by '" + file + "'", "name another raster"});
    const GdalErrors errors;
    const Dataset source(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (source) add(*source, file);
  }

  const std::string& first_;
  fs::path given_, target_;  // folders of the file as named and of its target
  std::vector<std::string> open_;
};

}  // namespace

std::vector<InputFile> filesOf(GDALDataset& dataset, const std::string& path) {
  std::vector<InputFile> files{{.path = path}};
  const CPLStringList listed(dataset.GetFileList());
  for (const std::string file : std::span(listed.List(), static_cast<std::size_t>(listed.size())))
    if (file != path) files.push_back({.path = file, .role = roleOf(file, isVirtual(dataset))});
  const auto beside = [&](const fs::path& side, std::string_view role) {
    std::error_code error;
    if (fs::is_regular_file(side, error) && std::ranges::count(files, side.string(), &InputFile::path) == 0)
      files.push_back({.path = side.string(), .role = std::string(role), .used = false});
  };
  for (const auto& [ending, role] : kAppended) beside(path + std::string(ending), role);
  for (const auto& [ending, role] : kReplacing) beside(fs::path(path).replace_extension(ending), role);
  return files;
}

void checkFiles(GDALDataset& dataset, const std::string& path) {
  Sources(path).add(dataset, path);
}

void requireRegularNeighbours(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  const std::string stem = lower(fs::path(path).stem().string());
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (!lower(at->path().filename().string()).starts_with(stem)) continue;
    const fs::file_status status = at->status(error);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
      throw InputError({at->path().string(),
                        "is a device, a FIFO or a socket beside or named by '" + path + "'",
                        "remove it or give a file"});
    error.clear();
  }
}

}  // namespace talus::maps
