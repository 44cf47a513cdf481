#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <new>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <unistd.h>

#include <talus/common/input_error.hpp>
#include <talus/common/input_file.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

void requireReadableFile(const std::string& path, const std::string& role) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError({path, "no such file", "check the path"});
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status))
    throw InputError({path, "is a device, a FIFO or a socket", "give a file"});
  if (std::filesystem::is_directory(status))
    throw InputError({path, "is a directory, not a file", "name the file inside it"});
  if (::access(path.c_str(), R_OK) != 0)
    throw InputError({path, std::string("cannot be read: ") + std::strerror(errno), "check its permissions"});
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0)
    throw InputError({path, "is empty", "fetch it again"});
  checkInput(path, role);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

void CloseDataset::operator()(GDALDataset* dataset) const noexcept {
  if (dataset != nullptr) dataset->ReleaseRef();
}

GdalErrors::GdalErrors() {
  CPLErrorReset();
  const auto keep = [](CPLErr kind, CPLErrorNum, const char* message) {
    auto& self = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (kind < CE_Warning || (kind == CE_Warning && self.failed_)) return;
    self.last_ = message;
    self.last_ = self.last_.substr(0, self.last_.find('\n'));
    self.failed_ = self.failed_ || kind >= CE_Failure;
  };
  CPLPushErrorHandlerEx(keep, this);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

std::string GdalErrors::last() const {
  return last_.empty() ? "unknown error" : last_;
}

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

namespace {

// Formats of elevation and layers. Drivers that access the network or run code are excluded.
constexpr const char* kDrivers[] = {"GTiff",   "COG",    "PDS4",        "PDS", "ISIS3", "ENVI",
                                    "AAIGrid", "netCDF", "JP2OpenJPEG", "PNG", "JPEG",  "USGSDEM",
                                    "SRTMHGT", "EHdr",   "GSAG",        "XYZ", "VICAR", nullptr};

// Formats of points, lines and areas in files without external schemas or styles.
constexpr const char* kVectorDrivers[] = {"GPKG", "ESRI Shapefile", "FlatGeobuf", "GPX",
                                          "KML",  "MapInfo File",   "GeoJSON",    nullptr};

bool holdsName(const char* const* drivers, std::string_view name) {
  for (; *drivers != nullptr; ++drivers)
    if (name == *drivers) return true;
  return false;
}

// Reopens an ASCII grid as Float64. By default, GDAL infers an integer type from the first values and reads
// "inf" and "nan" as 0.
Dataset withFractions(Dataset file, const std::string& path) {
  if (std::string_view(file->GetDriver()->GetDescription()) != "AAIGrid") return file;
  const std::uintmax_t values = valuesOfGrid(path),
                       cells = static_cast<std::uintmax_t>(file->GetRasterXSize()) *
                               static_cast<std::uintmax_t>(file->GetRasterYSize());
  if (values != cells)
    throw InputError({path,
                      "holds " + std::to_string(values) + " values, its header states " +
                          std::to_string(cells) + " cells: values were inserted or lost",
                      "fetch it again"});
  constexpr const char* kText[] = {"AAIGrid", nullptr};
  constexpr const char* kOptions[] = {"DATATYPE=Float64", nullptr};
  Dataset again(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kText, kOptions));
  if (!again) throw InputError({path, "cannot be opened again", "give a GeoTIFF"});
  return again;
}

}  // namespace

void registerDrivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    // Overrides environment settings that would write a log over any file, read options from a file, or
    // change the order in which cached blocks are written. GDAL reads these settings during or after the
    // registration of its drivers.
    CPLSetConfigOption("CPL_LOG", "");
    CPLSetConfigOption("CPL_DEBUG", "OFF");
    CPLSetConfigOption("GDAL_CONFIG_FILE", "");
    CPLSetConfigOption("GDAL_CACHEMAX", "5%");
    // Without this option, the missing rest of a truncated JPEG would be read as grey.
    CPLSetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", "TRUE");
    OSRSetPROJEnableNetwork(FALSE);  // prevents PROJ from downloading datum shift grids
    GDALAllRegister();
    // Deregistering all other drivers also limits files that GDAL opens implicitly, such as overviews named
    // in a file.
    GDALDriverManager& manager = *GetGDALDriverManager();
    for (int i = manager.GetDriverCount() - 1; i >= 0; --i) {
      GDALDriver* driver = manager.GetDriver(i);
      const std::string_view name = GDALGetDriverShortName(driver);
      const bool ours = name == "MEM" || name == "VRT";
      if (ours || holdsName(kDrivers, name) || holdsName(kVectorDrivers, name)) continue;
      manager.DeregisterDriver(driver);
      GDALDestroyDriver(driver);
    }
    CPLSetConfigOption("CPL_VSIL_CURL_ALLOWED_FILENAME", "none");
  });
}

std::vector<std::string> rasterFormats() {
  return {std::begin(kDrivers), std::end(kDrivers) - 1};
}

std::vector<std::string> vectorFormats() {
  return {std::begin(kVectorDrivers), std::end(kVectorDrivers) - 1};
}

std::vector<InputFile> filesOpenedWith(const std::string& path) {
  registerDrivers();
  const GdalErrors quiet;
  std::vector<InputFile> files{{.path = path}};
  if (const Dataset file{GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR | GDAL_OF_READONLY)})
    files = filesOf(*file, path);
  for (std::size_t i = 0, count = files.size(); i < count; ++i)
    files.push_back({.path = files[i].path + ".sha256", .role = "checksum"});
  return files;
}

void limitPixelCache(std::int64_t bytes) {
  GDALSetCacheMax64(bytes);
}

Dataset openRaster(const std::string& path, bool allow_vrt) {
  registerDrivers();
  requireReadableFile(path, "cells");
  requireRegularNeighbours(path);
  const GdalErrors errors;
  constexpr const char* kVirtual[] = {"VRT", nullptr};
  constexpr unsigned kHow = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  Dataset dataset(GDALDataset::Open(path.c_str(), kHow, kDrivers));
  if (!dataset && GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, kVirtual, nullptr) != nullptr) {
    if (!allow_vrt)
      throw InputError(
          {path, "is a virtual raster, which names other files", "pass --allow-vrt if you trust it"});
    dataset.reset(GDALDataset::Open(path.c_str(), kHow, kVirtual));
  }
  if (!dataset)
    throw InputError({path, "GDAL opens no raster of the allowed formats: " + errors.last(),
                      "give a GeoTIFF or another raster"});
  if (dataset->GetRasterCount() == 0 || dataset->GetRasterXSize() == 0 || dataset->GetRasterYSize() == 0)
    throw InputError({path, "holds no raster band", "name one of its subdatasets (gdalinfo lists them)"});
  // Of a TIFF GDAL warns of its structure and its place; of other formats also of conventions.
  std::array<double, 6> unused{};
  dataset->GetGeoTransform(unused.data());
  if (errors.anyWarning() && GDALGetDriverShortName(dataset->GetDriver()) == std::string_view("GTiff"))
    throw InputError({path, "GDAL warns of its structure: " + errors.last(),
                      "fetch it again, or write it again with gdal_translate"});
  checkFiles(*dataset, path);
  refuseDamaged(*dataset, path);
  return withFractions(std::move(dataset), path);
}

Dataset openVector(const std::string& path) {
  registerDrivers();
  requireReadableFile(path, "places");
  requireRegularNeighbours(path);
  const GdalErrors errors;
  constexpr unsigned kHow = GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  Dataset dataset(GDALDataset::Open(path.c_str(), kHow, kVectorDrivers));
  if (!dataset)
    throw InputError({path, "GDAL opens no vector file of the allowed formats: " + errors.last(),
                      "give a GeoPackage, GeoJSON, GPX, KML or shapefile"});
  checkFiles(*dataset, path);
  return dataset;
}

GDALDriver& driverNamed(const char* name) {
  registerDrivers();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr)
    throw InputError({std::string("GDAL's driver ") + name, "is missing, and Talus needs it",
                      "unset GDAL_SKIP, or install a GDAL with it"});
  return *driver;
}

Dataset memoryRaster(int width, int height, int type) {
  registerDrivers();
  GDALDriver& driver = driverNamed("MEM");
  Dataset dataset(driver.Create("", width, height, 1, static_cast<GDALDataType>(type), nullptr));
  if (!dataset) throw std::bad_alloc();
  return dataset;
}

MemoryFile::MemoryFile(const std::string& extension)
    : name("/vsimem/talus/" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "." + extension) {}

MemoryFile::~MemoryFile() {
  VSIUnlink(name.c_str());
}

std::string_view MemoryFile::bytes() const {
  vsi_l_offset size = 0;
  const GByte* data = VSIGetMemFileBuffer(name.c_str(), &size, FALSE);
  return {reinterpret_cast<const char*>(data), data == nullptr ? 0 : size};
}

}  // namespace talus::maps
