#include <algorithm>
#include <array>
#include <iterator>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/source_files.hpp>

namespace talus::maps {
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
