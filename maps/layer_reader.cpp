#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/maps/gdal_dataset.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/memory_budget.hpp>
#include <talus/maps/place.hpp>
#include <talus/maps/raster_band.hpp>
#include <talus/maps/warp.hpp>
#include <talus/talus.hpp>

namespace talus::maps {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

bool hasCrs(GDALDataset& file) {
  const OGRSpatialReference* crs = file.GetSpatialRef();
  return crs != nullptr && (crs->IsProjected() || crs->IsGeographic());
}

// A file without a CRS has the map's own coordinates; one of the map's very size without even a pixel size
// lies cell upon cell.
void adoptCoordinates(GDALDataset& file, const Grid& grid) {
  std::array<double, 6> transform{};
  const bool stated = file.GetGeoTransform(transform.data()) == CE_None;
  const bool same_size = file.GetRasterXSize() == grid.width && file.GetRasterYSize() == grid.height;
  const bool same_cells = stated && std::abs(transform[1] - grid.resolution_m) < 1e-6 * grid.resolution_m;
  if (same_cells || !same_size) return;
  transform = {
      grid.south_west.x_m, grid.resolution_m, 0, grid.south_west.y_m + grid.height * grid.resolution_m, 0,
      -grid.resolution_m};
  file.SetGeoTransform(transform.data());
}

// A band in memory, as floats without a no-data value.
Dataset inMemory(GDALDataset& file, int band, const std::string& path) {
  const int width = file.GetRasterXSize(), height = file.GetRasterYSize();
  requireMemory(8.0 * width * height, path);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  Dataset copy(driver->Create("", width, height, 1, GDT_Float32, nullptr));
  if (!copy) throw InputError({path, "does not fit into memory", "cut it to the map with gdalwarp"});
  std::array<double, 6> transform{};
  if (file.GetGeoTransform(transform.data()) == CE_None) copy->SetGeoTransform(transform.data());
  if (file.GetSpatialRef() != nullptr) copy->SetSpatialRef(file.GetSpatialRef());
  std::vector<float> row(static_cast<std::size_t>(width));
  std::vector<std::uint8_t> known(row.size());
  GDALRasterBand& from = *file.GetRasterBand(band);
  GDALRasterBand& mask = *from.GetMaskBand();
  for (int y = 0; y < height; ++y) {
    const bool read =
        from.RasterIO(GF_Read, 0, y, width, 1, row.data(), width, 1, GDT_Float32, 0, 0, nullptr) == CE_None &&
        mask.RasterIO(GF_Read, 0, y, width, 1, known.data(), width, 1, GDT_Byte, 0, 0, nullptr) == CE_None;
    if (!read)
      throw InputError({path, "row " + number(y) + " cannot be read", "the file is damaged or truncated"});
    for (std::size_t x = 0; x < row.size(); ++x)
      if (known[x] == 0) row[x] = std::numeric_limits<float>::quiet_NaN();
    if (copy->GetRasterBand(1)->RasterIO(GF_Write, 0, y, width, 1, row.data(), width, 1, GDT_Float32, 0, 0,
                                         nullptr) != CE_None)
      throw InputError({path, "does not fit into memory", "cut it to the map with gdalwarp"});
  }
  return copy;
}

// A band on the map's grid, first row south.
Raster<float> aligned(Dataset file, int band, const ElevationMap& map, const char* method,
                      const std::string& path) {
  const bool both_placed = hasCrs(*file) && map.georeference;
  if (!both_placed) {
    // GDAL warps between coordinates without a CRS only when neither has one.
    file->SetSpatialRef(nullptr);
    adoptCoordinates(*file, map.grid());
  }
  const Dataset warped = warp(*file,
                              {.band = band,
                               .wkt = both_placed ? map.georeference->system().wkt : "",
                               .resolution = 0.0,
                               .grid = map.grid(),
                               .method = method,
                               .nodata = std::nullopt},
                              path);
  const Grid& grid = map.grid();
  std::vector<float> values = readPixels(*warped, 1, {0, 0, grid.width, grid.height}, path);
  if (std::all_of(values.begin(), values.end(), [](float v) { return std::isnan(v); }))
    throw InputError({path, "does not overlap map '" + map.source + "'", "the map " + extent(grid)});
  return northUp(grid, std::move(values));
}

}  // namespace

Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map) {
  const GdalErrors quiet;
  Dataset file = openRaster(source.path);
  std::vector<std::string> notes;
  const int band =
      chooseBand(*file, {.path = source.path, .band = source.band, .words = {"class"}, .others = {}}, notes);
  const Raster<float> values = aligned(std::move(file), band, map, "near", source.path);
  Raster<std::uint8_t> classes(map.grid(), kNoClass);
  for (std::size_t i = 0; i < values.values().size(); ++i) {
    const float v = values.values()[i];
    if (std::isnan(v) || v == static_cast<float>(kNoClass)) continue;
    if (!(v >= 0 && v < kNoClass) || v != std::floor(v))
      throw InputError({source.path + ", band " + std::to_string(band),
                        "value " + number(static_cast<double>(v)) + " is not a class number (0 to 254)",
                        "name the band of classes"});
    classes.values()[i] = static_cast<std::uint8_t>(v);
  }
  return classes;
}

AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map) {
  const GdalErrors quiet;
  Dataset file = openRaster(source.path);
  if (source.band && (*source.band < 1 || *source.band > file->GetRasterCount()))
    throw InputError({source.path, "has no band " + std::to_string(*source.band), "name one that it has"});
  Dataset band = inMemory(*file, source.band.value_or(1), source.path);
  AddedJoules added;
  // The resampling leaves out what is not known: numbers that are greater than any other stand for it.
  constexpr float kMost = 1e6F, kUnknown = 1e38F, kBetween = 2e38F, kRefused = 3e38F;
  const auto marked = [&](float v) {
    if (std::isnan(v)) return kUnknown;
    if (v == std::numeric_limits<float>::infinity()) return kRefused;
    if (!(v >= 0 && v <= kMost))
      throw InputError({source.path, "value " + number(static_cast<double>(v)) + " J/m is not 0 to 1e6",
                        "nothing may make ground cheaper; write inf where the ground is refused"});
    added.dearest_J_per_m = std::max(added.dearest_J_per_m, v);
    return v;
  };
  const int width = band->GetRasterXSize();
  std::vector<float> row(static_cast<std::size_t>(width));
  for (int y = 0; y < band->GetRasterYSize(); ++y)
    for (const auto way : {GF_Read, GF_Write}) {
      if (band->GetRasterBand(1)->RasterIO(way, 0, y, width, 1, row.data(), width, 1, GDT_Float32, 0, 0,
                                           nullptr) != CE_None)
        throw InputError({source.path, "cannot be held in memory", ""});
      if (way == GF_Read) std::ranges::transform(row, row.begin(), marked);
    }
  added.J_per_m = aligned(std::move(band), 1, map, "max", source.path);
  for (float& v : added.J_per_m.values()) {
    if (v > kBetween)
      v = std::numeric_limits<float>::infinity();
    else if (v > kMost)
      v = std::numeric_limits<float>::quiet_NaN();
  }
  return added;
}

Raster<float> readRockAbundance(const LayerSource& source, const ElevationMap& map) {
  const GdalErrors quiet;
  Dataset file = openRaster(source.path);
  std::vector<std::string> notes;
  const int band = chooseBand(*file,
                              {.path = source.path,
                               .band = source.band,
                               .words = {"rock", "abundance", "_ra"},
                               .others = {"slope", "dem"}},
                              notes);
  Raster<float> share = aligned(std::move(file), band, map, "bilinear", source.path);
  for (float v : share.values())
    if (v < 0 || v > 1)
      throw InputError({source.path + ", band " + std::to_string(band),
                        "rock abundance " + number(static_cast<double>(v)) + " is not a fraction from 0 to 1",
                        v > 1 && v <= 100 ? "divide percents by 100" : "name the band of rock abundance"});
  return share;
}

}  // namespace talus::maps
