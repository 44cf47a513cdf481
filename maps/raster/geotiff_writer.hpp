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

/// One band of a GeoTIFF.
struct Layer {
  std::string name{};      ///< band description
  std::string unit{};      ///< "m", "rad", ...; "" for a dimensionless value
  Raster<float> values{};  ///< NaN = no data
};

/// Path and coordinate system of a GeoTIFF.
struct GeoTiff {
  std::string path{};
  const Georeference* georeference = nullptr;  ///< null: local metres without a CRS
  OutputFile* into = nullptr;  ///< output file that the caller commits; null: the function writes and commits
                               ///< `path`
};

/// Writes layers on a common grid as a tiled, compressed GeoTIFF. The file replaces `path` atomically
/// (OutputFile). @throws InputError if the file cannot be written, std::invalid_argument if the grids differ
/// or there is no layer
void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers);

/// Name and display colour of a class of an integer raster.
struct NamedClass {
  std::string name{};
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
};

/// Writes an integer raster (classes, masks) as a GeoTIFF with one band; `nodata` is declared as the no-data
/// value. With `classes`, entry i gives the name (band item CLASS_i) and the colour-table entry of value i,
/// and the file has overviews whose cells are the maximum of the cells beneath. @throws InputError if the
/// file cannot be written, std::invalid_argument for an empty raster
void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata, const std::vector<NamedClass>& classes = {});

}  // namespace talus::maps
