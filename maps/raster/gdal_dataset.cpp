#include <algorithm>
#include <iterator>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>

#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/referenced_files.hpp>

namespace talus::maps {
namespace {

// Formats of elevation and of layers; none that reaches out or runs code.
constexpr const char* kDrivers[] = {"GTiff",   "COG",    "PDS4",        "PDS", "ISIS3", "ENVI",
                                    "AAIGrid", "netCDF", "JP2OpenJPEG", "PNG", "JPEG",  "USGSDEM",
                                    "SRTMHGT", "EHdr",   "GSAG",        "XYZ", "VICAR", nullptr};

// Formats of places, lines and areas: files of their own, without schemas or styles from elsewhere.
constexpr const char* kVectorDrivers[] = {"GPKG", "ESRI Shapefile", "FlatGeobuf", "GPX",
                                          "KML",  "MapInfo File",   "GeoJSON",    nullptr};

bool holdsName(const char* const* drivers, std::string_view name) {
  for (; *drivers != nullptr; ++drivers)
    if (name == *drivers) return true;
  return false;
}

// Metadata inside of a GeoTIFF may name them, too; GDAL opens them when it is asked for overviews.
void refuseForeignOverviews(GDALDataset& dataset, const std::string& path) {
  const char* name = dataset.GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS");
  if (name != nullptr && std::string_view(name).find_first_of("/\\") != std::string_view::npos)
    throw InputError({path, "has its overviews in another folder", "make them again with gdaladdo"});
}

// GDAL takes a grid of text for whole numbers where its first ones are, and reads "inf" and "nan" as 0.
Dataset withFractions(Dataset file, const std::string& path) {
  if (std::string_view(file->GetDriver()->GetDescription()) != "AAIGrid") return file;
  refuseWordsInGrid(path);
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
    // What the environment may say of these is out of force: a log over any file, options from a file, and a cache that
    // decides the order in which blocks are written. GDAL reads them when its drivers are registered, or later.
    CPLSetConfigOption("CPL_LOG", "");
    CPLSetConfigOption("CPL_DEBUG", "OFF");
    CPLSetConfigOption("GDAL_CONFIG_FILE", "");
    CPLSetConfigOption("GDAL_CACHEMAX", "5%");
    CPLSetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", "TRUE");  // a cut picture is grey behind the cut
    OSRSetPROJEnableNetwork(FALSE);                               // PROJ would fetch grids of datum shifts
    GDALAllRegister();
    // What GDAL opens by itself, such as an overview that a file names, stays within the list, too.
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

void CloseDataset::operator()(GDALDataset* dataset) const noexcept {
  if (dataset != nullptr) dataset->ReleaseRef();
}

void limitPixelCache(std::int64_t bytes) {
  GDALSetCacheMax64(bytes);
}

Dataset openRaster(const std::string& path, bool allow_vrt) {
  registerDrivers();
  requireReadableFile(path);
  refuseForeignReferences(path, allow_vrt);
  const GdalErrors errors;
  constexpr const char* kVirtual[] = {"VRT", nullptr};
  constexpr unsigned kHow = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  Dataset dataset(GDALDataset::Open(path.c_str(), kHow, kDrivers));
  if (!dataset && allow_vrt) dataset.reset(GDALDataset::Open(path.c_str(), kHow, kVirtual));
  if (!dataset)
    throw InputError({path, "GDAL opens no raster of the allowed formats: " + errors.last(),
                      "give a GeoTIFF or another raster"});
  if (dataset->GetRasterCount() == 0 || dataset->GetRasterXSize() == 0 || dataset->GetRasterYSize() == 0)
    throw InputError({path, "holds no raster band", "name one of its subdatasets (gdalinfo lists them)"});
  refuseForeignOverviews(*dataset, path);
  refuseCutShort(*dataset, path);
  return withFractions(std::move(dataset), path);
}

Dataset openVector(const std::string& path) {
  registerDrivers();
  requireReadableFile(path);
  refuseForeignReferences(path, false);
  const GdalErrors errors;
  constexpr unsigned kHow = GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  Dataset dataset(GDALDataset::Open(path.c_str(), kHow, kVectorDrivers));
  if (!dataset)
    throw InputError({path, "GDAL opens no vector file of the allowed formats: " + errors.last(),
                      "give a GeoPackage, GeoJSON, GPX, KML or shapefile"});
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

}  // namespace talus::maps
