#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/maps/gdal_dataset.hpp>
#include <talus/maps/layer_reader.hpp>
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
