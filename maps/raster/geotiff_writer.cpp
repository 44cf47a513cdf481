#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_frame.hpp>

namespace talus::maps {
namespace {

struct Form {
  GDALDataType type = GDT_Float32;
  const char* predictor = "PREDICTOR=3";
  int bands = 1;
};

Dataset create(const std::string& path, const Grid& grid, const Form& form) {
  CPLStringList words;
  for (const char* word : {"TILED=YES", "COMPRESS=DEFLATE", "ZLEVEL=4", "BIGTIFF=IF_SAFER", form.predictor})
    words.AddString(word);
  return Dataset(driverNamed("GTiff").Create(path.c_str(), grid.width, grid.height, form.bands, form.type,
                                             words.List()));
}

void place(GDALDataset& file, const Grid& grid, const Georeference* georeference) {
  double transform[6] = {
      grid.south_west.x_m, grid.resolution_m, 0, grid.south_west.y_m + grid.height * grid.resolution_m, 0,
      -grid.resolution_m};
  file.SetGeoTransform(transform);
  if (georeference == nullptr) return;
  const OGRSpatialReference reference = spatialReference(georeference->system());
  file.SetSpatialRef(&reference);
}

// Raster rows run south to north and file rows north to south: the band is written from the last row with a
// negative line stride.
template <typename T>
CPLErr writeBand(GDALRasterBand& band, const Raster<T>& values, GDALDataType type) {
  const Grid& grid = values.grid();
  // GDAL's write call requires a non-const pointer
  auto* last_row = const_cast<T*>(values.row(grid.height - 1));
  const auto line = -static_cast<GSpacing>(grid.width) * static_cast<GSpacing>(sizeof(T));
  return band.RasterIO(GF_Write, 0, 0, grid.width, grid.height, last_row, grid.width, grid.height, type,
                       static_cast<GSpacing>(sizeof(T)), line, nullptr);
}

// Throws InputError. Without a PROJ database no CRS can be written; the remedy then names PROJ.
[[noreturn]] void fail(const GeoTiff& file, const GdalErrors& errors) {
  const std::string reason = errors.last();
  throw InputError({file.path, "cannot be written: " + reason,
                    reason.starts_with("PROJ")
                        ? "PROJ lacks its data: correct or unset PROJ_LIB and PROJ_DATA"
                        : "write fewer cells"});
}

// Closes the dataset, which completes its file in memory, and writes the file.
void finish(const GeoTiff& file, Dataset dataset, const MemoryFile& memory, const GdalErrors& errors) {
  dataset->FlushCache();
  dataset.reset();
  if (errors.any()) fail(file, errors);
  if (file.into != nullptr) return file.into->write(memory.bytes());
  writeFile(file.path, memory.bytes());
}

void describe(GDALRasterBand& band, const std::vector<NamedClass>& classes) {
  GDALColorTable colours;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const auto& [red, green, blue] = classes[i].colour;
    const GDALColorEntry entry{red, green, blue, 255};
    colours.SetColorEntry(static_cast<int>(i), &entry);
    band.SetMetadataItem(("CLASS_" + std::to_string(i)).c_str(), classes[i].name.c_str());
  }
  band.SetColorTable(&colours);
}

// Maximum of each block of level x level cells, northernmost row first. GDAL's resampling methods would omit
// a single cell of a greater class.
std::vector<std::uint8_t> greatestOf(const Raster<std::uint8_t>& values, int level, int width, int height) {
  const Grid& grid = values.grid();
  std::vector<std::uint8_t> coarse(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const int from_north = std::min((grid.height - 1 - row) / level, height - 1),
                at = std::min(column / level, width - 1);
      std::uint8_t& block = coarse[static_cast<std::size_t>(from_north) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(at)];
      block = std::max(block, values[{column, row}]);
    }
  return coarse;
}

// Adds overviews by factors of 2, the coarsest at most 512 cells wide and high. Returns false on failure.
bool addOverviews(GDALDataset& file, const Raster<std::uint8_t>& values) {
  const Grid& grid = values.grid();
  constexpr int kScreen = 512;
  std::vector<int> levels;
  for (int level = 2; std::max(grid.width, grid.height) * 2 > kScreen * level; level *= 2)
    levels.push_back(level);
  if (levels.empty()) return true;
  if (file.BuildOverviews("NONE", static_cast<int>(levels.size()), levels.data(), 0, nullptr, nullptr,
                          nullptr) != CE_None)
    return false;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    GDALRasterBand* band = file.GetRasterBand(1)->GetOverview(static_cast<int>(k));
    if (band == nullptr) return false;
    const int width = band->GetXSize(), height = band->GetYSize();
    std::vector<std::uint8_t> coarse = greatestOf(values, levels[k], width, height);
    if (band->RasterIO(GF_Write, 0, 0, width, height, coarse.data(), width, height, GDT_Byte, 0, 0,
                       nullptr) != CE_None)
      return false;
  }
  return true;
}

void checkGrids(const std::vector<Layer>& layers) {
  if (layers.empty()) throw std::invalid_argument("GeoTIFF: no layer");
  for (const Layer& layer : layers)
    if (layer.values.grid() != layers.front().values.grid() || layer.values.empty())
      throw std::invalid_argument("GeoTIFF: layer '" + layer.name + "' lies on another grid or is empty");
}

}  // namespace

void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers) {
  checkGrids(layers);
  const Grid& grid = layers.front().values.grid();
  const GdalErrors errors;
  const MemoryFile memory("tif");
  Dataset dataset = create(memory.name, grid, {.bands = static_cast<int>(layers.size())});
  if (!dataset) fail(file, errors);
  place(*dataset, grid, file.georeference);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    GDALRasterBand& band = *dataset->GetRasterBand(static_cast<int>(i) + 1);
    band.SetDescription(layers[i].name.c_str());
    if (!layers[i].unit.empty()) band.SetUnitType(layers[i].unit.c_str());
    band.SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
    if (writeBand(band, layers[i].values, GDT_Float32) != CE_None) fail(file, errors);
  }
  finish(file, std::move(dataset), memory, errors);
}

void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata, const std::vector<NamedClass>& classes) {
  if (values.empty()) throw std::invalid_argument("GeoTIFF: layer '" + name + "' is empty");
  const GdalErrors errors;
  const MemoryFile memory("tif");
  Dataset dataset = create(memory.name, values.grid(), {.type = GDT_Byte, .predictor = "PREDICTOR=2"});
  if (!dataset) fail(file, errors);
  place(*dataset, values.grid(), file.georeference);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  band.SetDescription(name.c_str());
  if (nodata) band.SetNoDataValue(*nodata);
  if (!classes.empty()) describe(band, classes);
  if (writeBand(band, values, GDT_Byte) != CE_None) fail(file, errors);
  if (!classes.empty() && !addOverviews(*dataset, values)) fail(file, errors);
  finish(file, std::move(dataset), memory, errors);
}

}  // namespace talus::maps
