#pragma once

#include <string>

#include <talus/maps/raster/read_options.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Reads a DEM: whatever GDAL opens, or a NumPy .npz archive with the arrays elevation, xmin, xmax, ymin,
/// ymax (degrees), as matplotlib ships one. Degrees, rotated and non-square pixels are resampled to square
/// cells in metres (recorded in the map's notes).
/// @throws InputError naming file, reason and remedy
ElevationMap readElevation(const std::string& path, const ReadOptions& options = {});

/// Where the cells lie that readElevation() would read, without reading them. @throws InputError, also for more cells than
/// `max_cells`
Grid elevationGrid(const std::string& path, const ReadOptions& options = {});

}  // namespace talus::maps
