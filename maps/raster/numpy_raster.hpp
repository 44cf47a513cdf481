#pragma once

#include <string>
#include <vector>

#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// True if the path ends in .npy or .npz.
bool isNumpyFile(const std::string& path);

/// Opens a NumPy elevation grid as an in-memory raster, north up. Reads the array of a .npy file, or of a
/// .npz archive the array "elevation", else the only two-dimensional array. The scalars xmin, xmax, ymin,
/// ymax of an archive, if present, are the outer edges: degrees on WGS 84 if their magnitudes permit. Limits
/// in reverse order are swapped, which is recorded in `notes`. @throws InputError
Dataset openNumpyRaster(const std::string& path, std::vector<std::string>& notes);

}  // namespace talus::maps
