#pragma once

#include <string>
#include <vector>

#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// Returns true if the path ends in .npy or .npz.
bool isNumpyFile(const std::string& path);

/// Opens a NumPy elevation grid as an in-memory raster, with north up. Reads the array of a .npy file. Of a
/// .npz archive, reads the array "elevation" or, if this is missing, the only two-dimensional array. The
/// scalars xmin, xmax, ymin, ymax of an archive, if present, are the outer edges of the grid, in degrees on
/// WGS 84 if their magnitudes permit. Limits in reverse order are swapped, and `notes` records the swap.
/// @throws InputError
Dataset openNumpyRaster(const std::string& path, std::vector<std::string>& notes);

}  // namespace talus::maps
