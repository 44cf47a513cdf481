#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

std::string_view driverOf(GDALDataset& dataset) {
  GDALDriver* driver = dataset.GetDriver();
  return driver == nullptr ? std::string_view() : GDALGetDriverShortName(driver);
}

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

std::string wordBehind(std::string_view key, const std::string& path) {
  std::ifstream file(path);
  for (std::string word, next; file >> word;)
    if (lower(word) == key && file >> next) return next;
  return "";
}

std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

std::string bytesAt(std::ifstream& file, std::uintmax_t begin, std::size_t count) {
  std::string bytes(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(begin));
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
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

// Checks the files of a dataset and of the sources of a virtual raster.
class Sources {
 public:
  explicit Sources(const std::string& path) : first_(path), given_(folderOf(path)) {
    std::error_code error;
    target_ = fs::weakly_canonical(path, error).parent_path();
  }

  void add(GDALDataset& dataset, const std::string& path) {
    open_.push_back(path);
    const std::vector<InputFile> files = filesOf(dataset, path);
    for (const InputFile& file : files)
      if (file.path != path) take(file);
    if (std::ranges::count(files, "auxiliary", &InputFile::role) > 0) requireAgreement(dataset, path);
    if (driverOf(dataset) == "VRT") requirePlainNames(dataset, path);
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
    if (file != path) files.push_back({.path = file, .role = roleOf(file, driverOf(dataset) == "VRT")});
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
constexpr const char* kDrivers[] = {"GTiff",  "COG",         "PDS4",  "PDS",  "ISIS3",   "ENVI",    "AAIGrid",
                                    "netCDF", "JP2OpenJPEG", "PNG",   "JPEG", "USGSDEM", "SRTMHGT", "EHdr",
                                    "GSAG",   "XYZ",         "VICAR", "PNM",  nullptr};

// Formats of points, lines and areas in files without external schemas or styles.
constexpr const char* kVectorDrivers[] = {"GPKG", "ESRI Shapefile", "FlatGeobuf", "GPX",
                                          "KML",  "MapInfo File",   "GeoJSON",    nullptr};

bool holdsName(const char* const* drivers, std::string_view name) {
  for (; *drivers != nullptr; ++drivers)
    if (name == *drivers) return true;
  return false;
}

void refuseDamagedClassic(const std::string& path);

// Reopens an ASCII grid as Float64. By default, GDAL infers an integer type from the first values and reads
// "inf" and "nan" as 0.
Dataset withFractions(Dataset file, const std::string& path) {
  if (driverOf(*file) != "AAIGrid") return file;
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
  refuseDamagedClassic(path);  // libnetcdf ends the program over a damaged header
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
    throw InputError({path, "holds no raster band",
                      "extract one of its subdatasets (gdalinfo lists them) with gdal_translate"});
  // Of a TIFF GDAL warns of its structure and its place; of other formats also of conventions.
  std::array<double, 6> unused{};
  dataset->GetGeoTransform(unused.data());
  if (errors.anyWarning() && driverOf(*dataset) == "GTiff")
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

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
// GDAL searches a label of PDS3 in as many bytes at most.
constexpr std::size_t kPds3Label = std::size_t{64} << 10U;

std::uintmax_t cellsOf(GDALDataset& dataset) {
  return static_cast<std::uintmax_t>(dataset.GetRasterXSize()) *
         static_cast<std::uintmax_t>(dataset.GetRasterYSize());
}

std::uintmax_t wholeNumber(const std::string& text) {
  std::uintmax_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::uintmax_t sizeOf(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

[[noreturn]] void refuseSize(const std::string& path, std::uintmax_t size, std::uintmax_t stated) {
  throw InputError({path,
                    "holds " + std::to_string(size) + " bytes, its label states " + std::to_string(stated) +
                        ": bytes were inserted or lost",
                    "fetch file and label again"});
}

void refuseFewerBytes(const std::string& path, std::uintmax_t needed) {
  if (const std::uintmax_t size = sizeOf(path); size < needed)
    throw InputError({path,
                      "is cut short: " + std::to_string(size) + " of " + std::to_string(needed) + " bytes",
                      "fetch it again"});
}

using Piece = std::pair<std::uintmax_t, std::uintmax_t>;  // bytes from the first to before the second

// Adds the objects (label, history, table) of an ISIS cube by their StartByte and Bytes.
void addObjects(const nlohmann::json& label, std::vector<Piece>& objects) {
  if (label.is_object() && label.contains("StartByte") && label.contains("Bytes") &&
      label["StartByte"].is_number_unsigned() && label["Bytes"].is_number_unsigned()) {
    const auto begin = label["StartByte"].get<std::uintmax_t>() - 1;
    objects.emplace_back(begin, begin + label["Bytes"].get<std::uintmax_t>());
  }
  if (label.is_structured())
    for (const auto& part : label) addObjects(part, objects);
}

nlohmann::json labelOf(GDALDataset& dataset, const char* domain) {
  char** text = dataset.GetMetadata(domain);
  nlohmann::json label = nlohmann::json::parse(text == nullptr ? "" : *text, nullptr, false);
  return label.is_object() ? label : nlohmann::json::object();
}

// File size [bytes] that the label of a raster of plain numbers states, beside the `end` of its pixels: of
// records (PDS3, VICAR), of the file (PDS4) or of the objects (ISIS) of which one begins at `end`. 0: none.
std::uintmax_t statedBytes(GDALDataset& dataset, const std::string& path, std::uintmax_t end,
                           std::uintmax_t size) {
  const std::string_view driver = driverOf(dataset);
  if (driver == "PDS") {
    const std::uintmax_t record = wholeNumber(pds3Keyword(path, "RECORD_BYTES")),
                         stated = record * wholeNumber(pds3Keyword(path, "FILE_RECORDS"));
    std::ifstream file(path, std::ios::binary);
    const std::string label = bytesAt(file, 0, kPds3Label);
    const bool alone = std::ranges::count(label.substr(0, label.find("\nEND")), '^') == 1;
    return alone && stated >= end + record ? 0 : stated;
  }
  if (driver == "ISIS3") {
    std::vector<Piece> objects;
    addObjects(labelOf(dataset, "json:ISIS3"), objects);
    const bool follows = std::ranges::count(objects, end, &Piece::first) > 0;
    return follows ? std::ranges::max(objects, {}, &Piece::second).second : 0;
  }
  if (driver == "VICAR") {
    const nlohmann::json label = labelOf(dataset, "json:VICAR");
    const auto record = label.value("RECSIZE", std::uintmax_t{0});
    return record == 0 || label.value("EOL", 0) == 0 ? 0 : size / record * record;
  }
  if (driver != "PDS4") return 0;
  char** xml = dataset.GetMetadata("xml:PDS4");
  const CPLXMLTreeCloser tree(CPLParseXMLString(xml == nullptr ? "" : *xml));
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  const CPLXMLNode* file = CPLSearchXMLNode(tree.get(), "=File");
  return file == nullptr ? 0 : wholeNumber(CPLGetXMLValue(file, "file_size", "0"));
}

// Rejects a raster of plain numbers whose file is shorter or longer than its label states: GDAL reads missing
// bytes as zeros, and a byte that was inserted moves all pixels behind it into other numbers.
void refuseOtherSize(GDALDataset& dataset, const std::string& path) {
  GDALDataset::RawBinaryLayout raw;
  if (driverOf(dataset) == "GTiff" || !dataset.GetRawBinaryLayout(raw)) return;
  if (raw.osRawFilename.empty()) raw.osRawFilename = path;
  // A negative offset runs towards the beginning of the file.
  const auto steps = [](int count, GIntBig bytes) {
    return static_cast<std::uintmax_t>(std::max(count - 1, 0)) *
           static_cast<std::uintmax_t>(std::max<GIntBig>(bytes, 0));
  };
  const std::uintmax_t end =
      std::uintmax_t{raw.nImageOffset} + steps(dataset.GetRasterCount(), raw.nBandOffset) +
      steps(dataset.GetRasterYSize(), raw.nLineOffset) + steps(dataset.GetRasterXSize(), raw.nPixelOffset) +
      static_cast<std::uintmax_t>(GDALGetDataTypeSizeBytes(raw.eDataType));
  refuseFewerBytes(raw.osRawFilename, end);
  const std::uintmax_t size = sizeOf(raw.osRawFilename), stated = statedBytes(dataset, path, end, size);
  // Lines may be longer than their pixels, also the last one.
  const std::uintmax_t whole_lines =
      std::uintmax_t{raw.nImageOffset} + steps(dataset.GetRasterYSize() + 1, raw.nLineOffset);
  if (size != end && size != stated && size != whole_lines)
    refuseSize(raw.osRawFilename, size, std::max(end, stated));
}

[[noreturn]] void refuseLabel(const std::string& path, const std::string& reason) {
  throw InputError({path, reason + ": a line is damaged or lost", "fetch it again, or correct it"});
}

// Rejects a label of PDS3 that ends another object than it begins: what is stated of the image would be lost.
void refuseOpenObjects(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::istringstream lines(bytesAt(file, 0, kPds3Label));
  std::vector<std::string> open;
  for (std::string line, key, equals, name; std::getline(lines, line) && key != "END";) {
    std::istringstream words(line);
    name.clear();
    if (!(words >> key)) continue;
    words >> equals >> name;
    if (key == "OBJECT") open.push_back(name);
    if (key != "END_OBJECT") continue;
    if (open.empty() || (!name.empty() && open.back() != name))
      refuseLabel(path, "ends an object " + name.substr(0, 40) + " that does not begin");
    open.pop_back();
  }
}

struct PixelScale {
  double length, per_degree, radius;  // of a pixel [km or m], pixels, of the body; 0: not stated
};

// Rejects a pixel that is stated twice: pixels per degree times the size of a pixel is a degree on the sphere, within 2 %
// on ellipsoids.
void refuseOtherPixels(const PixelScale& map, const std::string& path) {
  const double degree = map.length * map.per_degree, own = map.radius * std::numbers::pi / 180.0;
  const auto near = [&](double length) { return std::abs(degree - length) <= 0.02 * length; };
  if (degree > 0.0 && own > 0.0 && !near(own) && !near(1000.0 * own))
    throw InputError(
        {path, "states a size of pixels and pixels per degree that differ", "correct one of them"});
}

// Rejects pixels that GDAL reads as other numbers or in another order than the label states.
void refuseMisread(GDALDataset& dataset, const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw InputError({path, what + ", which GDAL reads as other numbers", "convert it to a GeoTIFF"});
  };
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const char* signed_byte = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  if (signed_byte != nullptr && signed_byte == std::string_view("SIGNEDBYTE")) refuse("holds signed bytes");
  if (driverOf(dataset) == "PDS") {
    const std::string type = pds3Keyword(path, "SAMPLE_TYPE", "IMAGE");
    const bool integers = type.find("INTEGER") != type.npos;
    if (integers && (GDALDataTypeIsFloating(band.GetRasterDataType()) != FALSE ||
                     (band.GetRasterDataType() == GDT_Byte && type.find("UNSIGNED") == type.npos)))
      refuse("holds pixels of SAMPLE_TYPE " + type + " and SAMPLE_BITS " +
             pds3Keyword(path, "SAMPLE_BITS", "IMAGE"));
    if (wholeNumber(pds3Keyword(path, "LINE_SUFFIX_BYTES", "IMAGE")) > 0) refuse("has LINE_SUFFIX_BYTES");
    refuseOpenObjects(path);
    const auto map = [&](const char* key) { return std::atof(pds3Keyword(path, key).c_str()); };
    refuseOtherPixels({map("MAP_SCALE"), map("MAP_RESOLUTION"), map("A_AXIS_RADIUS")}, path);
  }
  if (driverOf(dataset) == "ISIS3") {
    const auto mapping =
        labelOf(dataset, "json:ISIS3")
            .value(nlohmann::json::json_pointer("/IsisCube/Mapping"), nlohmann::json::object());
    const auto map = [&](const char* key) {
      const nlohmann::json stated = mapping.value(key, nlohmann::json());
      const nlohmann::json plain = stated.is_object() ? stated.value("value", nlohmann::json()) : stated;
      return plain.is_number() ? plain.get<double>() : 0.0;
    };
    refuseOtherPixels({map("PixelResolution"), map("Scale"), map("EquatorialRadius")}, path);
  }
  GDALDataset::RawBinaryLayout raw;
  if (driverOf(dataset) == "EHdr" && dataset.GetRawBinaryLayout(raw))
    for (const InputFile& side : filesOf(dataset, path)) {
      const auto stated = [&](const char* key) {
        return side.role == "label" ? wordBehind(key, side.path) : "";
      };
      if (const std::string bytes = stated("totalrowbytes");
          !bytes.empty() && wholeNumber(bytes) != static_cast<std::uintmax_t>(raw.nLineOffset))
        refuse("has lines of " + bytes.substr(0, 20) + " bytes (TOTALROWBYTES)");
      constexpr const char* kPlace[] = {"ulxmap", "ulymap", "xdim", "ydim"};
      const auto keys = std::ranges::count_if(kPlace, [&](const char* key) { return !stated(key).empty(); });
      if (keys % 4 != 0) refuseLabel(side.path, "states only a part of ULXMAP, ULYMAP, XDIM and YDIM");
    }
  char** xml = driverOf(dataset) == "PDS4" ? dataset.GetMetadata("xml:PDS4") : nullptr;
  if (xml != nullptr && std::string_view(*xml).find("Right to Left") != std::string_view::npos)
    refuse("states Right to Left");
}

// Directories of a TIFF (TIFF 6.0, section 2; BigTIFF), and the bytes that its statements and blocks take.
class TiffLayout {
 public:
  explicit TiffLayout(const std::string& path)
      : path_(path), file_(path, std::ios::binary), size_(sizeOf(path)) {
    swapped_ = bytesAt(file_, 0, 1) == "M";
    big_ = number(2, 2) == 43;
    wide_ = big_ ? 8 : 4;
    pieces_.emplace_back(0, 2 * wide_);
    for (std::uintmax_t next = number(wide_, wide_); next != 0 && images_ < kMostImages; ++images_)
      next = readDirectory(next, images_ == 0);
    while (!waiting_.empty() && pieces_.size() < kMostPieces) {
      const std::uintmax_t next = waiting_.back();
      waiting_.pop_back();
      readDirectory(next, false);
    }
  }

  std::size_t images() const { return images_; }
  // True if a block of the first image was never written.
  bool isSparse() const { return std::ranges::count(counts_, 0U) > 0; }

  // Throws InputError if statements or blocks lie in each other or beyond the file; of an uncompressed raster also
  // if a block has another size than its cells, or the file bytes behind all blocks and statements.
  void check() {
    std::ranges::sort(pieces_);
    // Equal blocks may be stored once.
    pieces_.erase(std::unique(pieces_.begin(), pieces_.end()), pieces_.end());
    std::uintmax_t end = 0;
    for (const auto& [first, past] : pieces_) {
      refuseIf(first < end, "has blocks or tags that overlap");
      end = past;
    }
    refuseIf(end > size_, "is cut short: blocks or tags lie beyond its end");
    if (first_.contains(259) && of(259) != 1) return;
    refuseIf(!holdsItsCells(), "states blocks of another size than its cells have");
    const bool trailer = bytesAt(file_, 2 * wide_, 24) == "GDAL_STRUCTURAL_METADATA";
    refuseIf(size_ != end && size_ != end + end % 2 && !(trailer && size_ == end + 4),
             "holds bytes behind all blocks and tags: bytes were inserted or lost");
  }

 private:
  static constexpr std::size_t kMostImages = 1000, kMostPieces = 10'000'000;

  void refuseIf(bool differs, const char* what) const {
    if (differs) throw InputError({path_, what, "fetch it again, or write it again with gdal_translate"});
  }

  std::uintmax_t number(std::uintmax_t at, std::size_t count) {
    std::string bytes = bytesAt(file_, at, count);
    bytes.resize(count, '\0');
    return valueOf(bytes);
  }
  std::uintmax_t valueOf(std::string bytes) const {
    if (swapped_) std::ranges::reverse(bytes);
    return littleEndian(bytes, 0, bytes.size());
  }

  // Returns the place of the next directory.
  std::uintmax_t readDirectory(std::uintmax_t at, bool first) {
    constexpr std::array<std::size_t, 19> kSizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
    const std::uintmax_t count = std::min<std::uintmax_t>(number(at, big_ ? 8 : 2), 65535),
                         begin = at + (big_ ? 8 : 2), entry = 4 + 2 * wide_, end = begin + count * entry;
    pieces_.emplace_back(at, end + wide_);
    Tags tags;
    for (std::uintmax_t e = begin; e < end; e += entry) {
      const std::uintmax_t type = number(e + 2, 2), values = number(e + 4, wide_);
      const std::size_t size = type < kSizes.size() ? kSizes[type] : 0;
      refuseIf(values > size_, "has a tag beyond its end");
      const std::uintmax_t bytes = values * size,
                           place = bytes > wide_ ? number(e + 4 + wide_, wide_) : e + 4 + wide_;
      if (bytes > wide_) pieces_.emplace_back(place, place + bytes);
      const std::string content = bytesAt(file_, place, bytes);
      std::vector<std::uintmax_t>& of_tag = tags[number(e, 2)];
      for (std::size_t k = 0; size > 0 && k + size <= content.size() && size <= 8; k += size)
        of_tag.push_back(valueOf(content.substr(k, size)));
    }
    for (const std::uintmax_t nested : {330U, 34665U, 34853U})
      if (const auto found = tags.find(nested); found != tags.end())
        waiting_.insert(waiting_.end(), found->second.begin(), found->second.end());
    const bool tiled = tags.contains(324);
    const auto& offsets = tags[tiled ? 324 : 273];
    auto& counts = tags[tiled ? 325 : 279];
    counts.resize(offsets.size());
    for (std::size_t k = 0; k < offsets.size(); ++k)
      if (counts[k] != 0) pieces_.emplace_back(offsets[k], offsets[k] + counts[k]);
    if (first) counts_ = counts, first_ = std::move(tags);
    return number(end, wide_);
  }

  std::uintmax_t of(std::uintmax_t tag, std::uintmax_t otherwise = 1) const {
    const auto found = first_.find(tag);
    return found == first_.end() || found->second.empty() ? otherwise : found->second.front();
  }

  bool holdsItsCells() const {
    const bool tiled = first_.contains(322), apart = of(284) == 2;
    const std::uintmax_t width = tiled ? of(322) : of(256),
                         rows = tiled ? of(323) : std::min(of(278, of(257)), of(257));
    if (width == 0 || rows == 0) return false;
    const std::uintmax_t line = (width * of(258) * (apart ? 1 : of(277)) + 7) / 8,
                         across = (of(256) + width - 1) / width, down = (of(257) + rows - 1) / rows;
    if (counts_.size() != across * down * (apart ? of(277) : 1)) return false;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      const std::uintmax_t row = k / across % down,
                           held = tiled ? rows : std::min(rows, of(257) - row * rows);
      if (counts_[k] != 0 && counts_[k] != held * line) return false;
    }
    return true;
  }

  using Tags = std::map<std::uintmax_t, std::vector<std::uintmax_t>>;

  const std::string& path_;
  std::ifstream file_;
  std::uintmax_t size_;
  bool swapped_ = false, big_ = false;
  std::size_t wide_ = 4, images_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::uintmax_t> waiting_, counts_;  // directories; bytes of the blocks of the first image
  Tags first_;
};

// Rejects a GeoTIFF whose bytes contradict each other, that lacks blocks without a no-data value (GDAL would read
// zeros), or with an image that GDAL uses neither as the raster nor as its overview or mask: one bit of its header
// separates a mask from the raster.
void refuseDamagedTiff(GDALDataset& dataset, const std::string& path) {
  if (driverOf(dataset) != "GTiff") return;
  TiffLayout layout(path);
  layout.check();
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  int stated = 0;
  band.GetNoDataValue(&stated);
  if (layout.isSparse() && stated == 0)
    throw InputError(
        {path, "is half written: blocks are missing without a no-data value",
         "write it again, or state one with gdal_edit.py -a_nodata if they are meant to be empty"});
  const std::vector<InputFile> files = filesOf(dataset, path);
  const auto beside = [&](const char* role) { return std::ranges::count(files, role, &InputFile::role) > 0; };
  int used = 1 + (beside("overviews") ? 0 : band.GetOverviewCount());
  const bool masked = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
  if (beside("mask")) TiffLayout(path + ".msk").check();
  if (beside("mask") && !masked)
    throw InputError({path + ".msk", "lacks INTERNAL_MASK_FLAGS, by which GDAL knows a mask",
                      "write it again with gdal_translate -mask, or remove it"});
  if (masked && !beside("mask")) used += 1 + band.GetMaskBand()->GetOverviewCount();
  if (layout.images() > static_cast<std::size_t>(used))
    throw InputError({path, "holds a further image, neither raster, overview nor mask",
                      "fetch it again; if it is meant to, take its image out with gdal_translate GTIFF_DIR:" +
                          std::to_string(used + 1) + ":" + path});
}

// Parser of a netCDF-3 header ("The NetCDF Classic Format Specification", Unidata). A read beyond the end of
// the file sets the failure state of the stream.
class ClassicHeader {
 public:
  explicit ClassicHeader(const std::string& path) : path_(path), file_(path, std::ios::binary) {}

  // Offset [bytes] of the end of the last variable; nullopt if the file is not netCDF-3.
  std::optional<std::uintmax_t> end() {
    char magic[4] = {};
    file_.read(magic, 4);
    if (!file_ || std::string_view(magic, 3) != "CDF" || (magic[3] != 1 && magic[3] != 2 && magic[3] != 5))
      return std::nullopt;
    wide_ = magic[3] == 5;
    offset_bytes_ = magic[3] == 1 ? 4 : 8;
    const std::uintmax_t stated = number(countBytes());
    const bool streamed =
        // value for an unknown number of records
        stated == (wide_ ? UINTMAX_MAX : UINTMAX_C(0xffffffff));
    readDimensions();
    skipAttributes();
    readVariables();
    if (!file_) throw InputError({path_, "is cut short within its header", "fetch it again"});
    std::uintmax_t end = static_cast<std::uintmax_t>(file_.tellg());
    const std::uintmax_t records = streamed ? 0 : stated;
    const std::uintmax_t of_records = recordBytes();
    for (const Variable& v : variables_) {
      if (!v.by_record)
        end = std::max(end, v.begin + v.bytes);
      else if (records > 0)
        end = std::max(end, v.begin + (records - 1) * of_records + v.bytes);
    }
    return end;
  }

 private:
  struct Variable {
    std::uintmax_t begin, bytes;  // size of the variable, or of one record of it
    bool by_record;
  };
  static constexpr std::uintmax_t kMost = 1'000'000;  // limit of dimensions, attributes or variables

  int countBytes() const { return wide_ ? 8 : 4; }
  static std::uintmax_t padded(std::uintmax_t bytes) { return (bytes + 3) / 4 * 4; }

  std::uintmax_t number(int bytes) {
    std::uintmax_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<unsigned char>(static_cast<char>(file_.get()));
    return file_ ? value : 0;
  }
  // Length of a list. A length above kMost sets the failure state of the stream.
  std::uintmax_t length() {
    const std::uintmax_t tag = number(4);
    const std::uintmax_t count = number(countBytes());
    const bool known = tag == 0 ? count == 0 : tag >= 10 && tag <= 12;
    if (count > kMost || !known) file_.setstate(std::ios::failbit);
    return file_ ? count : 0;
  }
  void skip(std::uintmax_t bytes) { file_.seekg(static_cast<std::streamoff>(padded(bytes)), std::ios::cur); }
  void skipName() { skip(number(countBytes())); }

  static std::uintmax_t bytesOfType(std::uintmax_t type) {
    constexpr std::uintmax_t kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < std::size(kBytes) ? kBytes[type] : 0;
  }

  void readDimensions() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      dimensions_.push_back(number(countBytes()));
    }
  }
  void skipAttributes() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      const std::uintmax_t bytes = bytesOfType(number(4));
      skip(bytes * number(countBytes()));
    }
  }
  void readVariables() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      std::uintmax_t axes = number(countBytes()), count = 1;
      bool by_record = false;
      if (axes > kMost) file_.setstate(std::ios::failbit);
      for (; axes > 0 && file_; --axes) {
        const std::uintmax_t id = number(countBytes());
        if (id >= dimensions_.size()) file_.setstate(std::ios::failbit);
        const std::uintmax_t extent = id < dimensions_.size() ? dimensions_[id] : 0;
        by_record = by_record || extent == 0;
        count *= std::max<std::uintmax_t>(extent, 1);
      }
      skipAttributes();
      const std::uintmax_t bytes = bytesOfType(number(4)) * count;
      number(countBytes());  // vsize, which is unreliable for large variables
      variables_.push_back({number(offset_bytes_), bytes, by_record});
    }
  }
  // Size of one record [bytes]. Record variables are padded to 4 bytes, except a single record variable.
  std::uintmax_t recordBytes() const {
    std::uintmax_t sum = 0, own = 0, count = 0;
    for (const Variable& v : variables_)
      if (v.by_record) {
        sum += padded(v.bytes);
        own = v.bytes;
        ++count;
      }
    return count == 1 ? own : sum;
  }

  const std::string& path_;
  std::ifstream file_;
  bool wide_ = false;
  int offset_bytes_ = 4;
  std::vector<std::uintmax_t> dimensions_;
  std::vector<Variable> variables_;
};

void refuseDamagedClassic(const std::string& path) {
  ClassicHeader(path).end();
}

// Calls each(character, line) for all bytes of a file.
template <typename Each>
void eachByte(const std::string& path, Each each) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(kPiece, '\0');
  std::size_t line = 1;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0)
    for (const char c : std::string_view(piece.data(), static_cast<std::size_t>(file.gcount()))) {
      each(c, line);
      line += c == '\n' ? 1U : 0U;
    }
}

// Rejects a table of numbers with control bytes or non-ASCII bytes, and one that ends with a digit or a point: its
// last number may be incomplete.
void refuseForeignBytes(const std::string& path) {
  char last = '\n';
  eachByte(path, [&](char c, std::size_t line) {
    const auto byte = static_cast<unsigned char>(last = c);
    if (byte >= 0x80 || (byte < 0x20 && std::isspace(byte) == 0))
      throw InputError(
          {path + ":" + std::to_string(line),
           "holds the byte " + std::to_string(byte) + " among its numbers, as a damaged file does",
           "fetch it again"});
  });
  if (std::isdigit(static_cast<unsigned char>(last)) != 0 || last == '.')
    throw InputError({path, "ends within a number, as a file that is cut short does",
                      "fetch it again; if it is whole, end its last line"});
}

constexpr std::size_t kLongest = 400;  // longest accepted number [characters]
// True if a word is a number for GDAL, which accepts a decimal comma.
bool isNumber(std::string_view word) {
  if (word.size() > kLongest) return false;
  std::string text(word);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::count(text, ',') == 1 && text.find('.') == text.npos) std::ranges::replace(text, ',', '.');
  std::string_view rest = text;
  if (rest.starts_with('+') || rest.starts_with('-')) rest.remove_prefix(1);
  for (const std::string_view known : {"nan", "inf", "infinity", "1.#inf", "1.#ind", "1.#qnan", "1.#snan"})
    if (rest == known) return true;
  if (rest.starts_with('+') || rest.starts_with('-')) return false;
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  return error != std::errc::invalid_argument && end == rest.data() + rest.size();
}

bool isKey(std::string_view word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !isNumber(word);
}

// Checks the words of an ASCII grid in order: header keys, each followed by a number, then numbers only.
class Words {
 public:
  explicit Words(const std::string& path) : path_(path) {}

  void take(std::string_view word, std::size_t line) {
    if (header_ && !value_of_key_ && isKey(word)) {
      value_of_key_ = true;
      keys_ += ' ' + lower(std::string(word));
      return;
    }
    if (!value_of_key_) header_ = false;
    value_of_key_ = false;
    values_ += header_ ? 0 : 1;
    if (isNumber(word)) return;
    throw InputError({path_ + ":" + std::to_string(line),
                      "'" + std::string(word.substr(0, 40)) + "' is not a number",
                      "write the NODATA_value, or nan, where nothing is known"});
  }

  std::uintmax_t values() const {
    const auto has = [&](const char* key) { return keys_.find(key) != keys_.npos; };
    if (const bool size = has(" cellsize") || has(" dx"); size != has(" xllc") || size != has(" yllc"))
      refuseLabel(path_, "states only a part of xllcorner, yllcorner and cellsize");
    return values_;
  }

 private:
  const std::string& path_;
  std::string keys_{};
  bool header_ = true, value_of_key_ = false;
  std::uintmax_t values_ = 0;
};

}  // namespace

void refuseDamaged(GDALDataset& dataset, const std::string& path) {
  const std::string_view driver = driverOf(dataset);
  refuseMisread(dataset, path);
  refuseOtherSize(dataset, path);
  refuseDamagedTiff(dataset, path);
  if (driver == "netCDF")
    if (const auto end = ClassicHeader(path).end()) {
      refuseFewerBytes(path, *end);
      if (sizeOf(path) > (*end + 3) / 4 * 4) refuseSize(path, sizeOf(path), *end);
    }
  // Each value takes at least two bytes: a digit and a separator.
  if (driver == "AAIGrid" || driver == "GSAG") refuseFewerBytes(path, 2 * cellsOf(dataset));
  if (driver == "AAIGrid" || driver == "GSAG" || driver == "XYZ") refuseForeignBytes(path);
  if (driver == "VRT")
    for (const InputFile& file : filesOf(dataset, path))
      if (const Dataset source{file.role == "source"
                                   ? GDALDataset::Open(file.path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY)
                                   : nullptr})
        refuseDamaged(*source, file.path);
}

std::string pds3Keyword(const std::string& path, const std::string& keyword, const std::string& object) {
  std::ifstream file(path, std::ios::binary);
  const std::string text = bytesAt(file, 0, kPds3Label);
  std::istringstream lines(text.substr(0, text.find('\0')));
  bool inside = object.empty();
  for (std::string line, key, equals, value; std::getline(lines, line) && key != "END";) {
    std::istringstream words(line);
    if (!(words >> key >> equals >> value) || equals != "=") continue;
    std::erase(value, '"');
    if (inside && key == keyword) return value;
    if (value == object && (key == "OBJECT" || key == "END_OBJECT")) inside = key == "OBJECT";
  }
  return "";
}

std::uintmax_t valuesOfGrid(const std::string& path) {
  std::string word;
  Words words(path);
  std::size_t last = 1;
  eachByte(path, [&](char c, std::size_t line) {
    const bool between = c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
    if (!between && word.size() <= kLongest) word += c;
    if (between && !word.empty()) {
      words.take(word, line);
      word.clear();
    }
    last = line;
  });
  if (!word.empty()) words.take(word, last);
  return words.values();
}

}  // namespace talus::maps
