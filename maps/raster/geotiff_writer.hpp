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
  std::string unit{};      ///< "m", "rad", "" for a ratio
  Raster<float> values{};  ///< NaN = no data
};

/// What is common to all bands.
struct GeoTiff {
  std::string path{};
  const Georeference* georeference = nullptr;  ///< none: local metres
  OutputFile* into = nullptr;  ///< to be filled and left to the caller to put in its place, as one of several
};

/// Writes layers of one grid as a tiled, compressed GeoTIFF beside `path`, then renames it there: a reader
/// sees the whole file or none.
/// @throws InputError when it cannot be written, std::invalid_argument when grids differ or none is given
void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers);

/// A class of a raster of whole numbers, as programs list and draw it.
struct NamedClass {
  std::string name{};
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
};

/// The same for whole numbers (classes, masks) in one band; `nodata` cells are marked. With `classes`, those of 0, 1 ... have a
/// colour table and names (items CLASS_0 ... of the band), and the file has overviews, each cell the greatest class under it.
void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata, const std::vector<NamedClass>& classes = {});

}  // namespace talus::maps
