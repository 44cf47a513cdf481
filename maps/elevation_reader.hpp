#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <talus/maps/elevation_map.hpp>
#include <talus/maps/place.hpp>

namespace talus::maps {

/// How a raster file is read.
struct ReadOptions {
  std::optional<int> band{};             ///< from 1; unset: the band named like elevation, else the first
  std::optional<double> resolution_m{};  ///< cell side; must be given without a CRS, resamples with one
  std::optional<Window> window{};        ///< part of the file, in the file's map metres or degrees
  std::optional<double> nodata{};        ///< value that means no data, over what the file says
  double vertical_scale = 1.0;           ///< metres per unit of the file, on top of the unit it states
  bool ignore_crs = false;               ///< the file's CRS is wrong: read as local metres
  int overview =
      1;  ///< cells to a side that are read as one, their mean, from the file's overviews if it has some
  std::uint64_t max_cells = 400'000'000;  ///< refuse larger maps (1.6 GB as float)
};

/// Reads a DEM: whatever GDAL opens, or a NumPy .npz archive with the arrays elevation, xmin, xmax, ymin,
/// ymax (degrees), as matplotlib ships one. Degrees, rotated and non-square pixels are resampled to square
/// cells in metres (the map's notes say so).
/// @throws InputError naming file, reason and remedy
ElevationMap readElevation(const std::string& path, const ReadOptions& options = {});

/// Where the cells lie that readElevation() would read, without reading them. @throws InputError
Grid elevationGrid(const std::string& path, const ReadOptions& options = {});

}  // namespace talus::maps
