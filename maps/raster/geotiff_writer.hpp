#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus {
class OutputFile;
}

namespace talus::maps {

/// One band of a GeoTIFF file.
struct Layer {
  std::string name{};      ///< band description
  std::string unit{};      ///< unit of the values: "m", "rad", ...; empty for a dimensionless quantity
  Raster<float> values{};  ///< values of the cells; NaN marks cells without data
};

/// Path and coordinate reference system (CRS) of a GeoTIFF file.
struct GeoTiff {
  std::string path{};
  /// Coordinate system of the file; null: local metres without a CRS.
  const Georeference* georeference = nullptr;
  /// Output file that the caller commits. Null: the writing function creates `path` and commits it.
  OutputFile* into = nullptr;
};

/// Writes layers on a common grid as bands of a tiled, compressed GeoTIFF file. The file replaces file.path
/// atomically (OutputFile). @throws InputError if the file cannot be written, std::invalid_argument if the
/// grids of the layers differ or if there is no layer
void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers);

/// Name and display colour of a class of an integer raster.
struct NamedClass {
  std::string name{};
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
};

/// Writes an integer raster (terrain classes, masks) as a GeoTIFF file with one band named `name`. The file
/// declares `nodata` as the value of cells without data. With `classes`, entry i gives the name (band item
/// CLASS_i) and the colour of the value i, and the file has overviews, i.e. coarser copies whose cells are
/// the maximum of the cells that they cover. @throws InputError if the file cannot be written,
/// std::invalid_argument for an empty raster
void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata, const std::vector<NamedClass>& classes = {});

}  // namespace talus::maps
