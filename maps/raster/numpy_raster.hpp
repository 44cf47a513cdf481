#pragma once

#include <string>
#include <vector>

#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// Whether a path names a NumPy file by its ending (.npy, .npz).
bool isNumpyFile(const std::string& path);

/// A NumPy elevation grid as a raster in memory, north up: the array of a .npy, or of a .npz the array
/// "elevation" or else its only array of two axes, with xmin, xmax, ymin, ymax (outer edges) where it has
/// them: degrees on WGS 84 when they can be. Limits in the wrong order are swapped and said in `notes`.
/// @throws InputError
Dataset openNumpyRaster(const std::string& path, std::vector<std::string>& notes);

}  // namespace talus::maps
