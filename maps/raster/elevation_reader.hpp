#pragma once

#include <string>

#include <talus/maps/raster/read_options.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Returns the elevation map of a file: any raster that GDAL opens, or a NumPy .npz archive with the arrays
/// elevation, xmin, xmax, ymin, ymax (degrees), as distributed with matplotlib. Rasters in degrees, and
/// rasters with rotated or non-square pixels, are resampled to square cells in metres; ElevationMap::notes
/// record the resampling. A cell without data is interpolated if at least three pairs of opposite neighbours
/// are known and their means agree within a quarter of the cell's side (ours), unless ReadOptions::keep_holes.
/// @throws InputError with file, reason and remedy
ElevationMap readElevation(const std::string& path, const ReadOptions& options = {});

/// Returns the grid of the map that readElevation() would return, without reading the elevations. @throws
/// InputError, also if the grid exceeds ReadOptions::max_cells
Grid elevationGrid(const std::string& path, const ReadOptions& options = {});

}  // namespace talus::maps
