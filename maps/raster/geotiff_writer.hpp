#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

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
};

/// Writes layers of one grid as a tiled, compressed GeoTIFF beside `path`, then renames it there: a reader
/// sees the whole file or none.
/// @throws InputError when it cannot be written, std::invalid_argument when grids differ or none is given
void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers);

/// The same for whole numbers (classes, masks) in one band; `nodata` cells are marked.
void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata);

}  // namespace talus::maps
